//! The published ramp without the harness: the kidney of 1331 nodes, fixed at the top, between two jaws of 4
//! N, as in `cases/scenes/kidney/kidney-paper-explicit.toml`.

use std::path::Path;

use contact::{ContactLaw, ContactSurface, Drive, RoundedBox, Tool, ToolShape};
use fem::{SurfaceRule, VolumeRule};
use lanes::LanePath;
use material::Law;
use shape::{Matrix3, Point3, SurfaceRows, Vector3, VolumeRows};
use tissuebench_explicit::{
    Dynamics, DynamicsParams, ExplicitBody, InternalForce, LanczosParams, Lumping, MovingTool, Prescribed,
    Springs, Tools, critical_step_touching, lumped_mass,
};

const LANCZOS: LanczosParams = LanczosParams { steps: 15, safety: 0.95 };
const PENALTY: f64 = 5e8;

/// Body with its surface and jaws.
pub struct Body {
    volume: VolumeRows,
    surface: SurfaceRows,
    mass: Vec<f64>,
    held: Vec<u32>,
    jaws: [Tool; 2],
}

impl Body {
    pub fn new() -> Body {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/scenes/kidney/kidney-1331.msh");
        let mesh = mesh_files::read(&file, 1e-3).unwrap();
        let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
        let surface = fem::surface_rows(&mesh, &mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
        let mass = lumped_mass(&volume, &[1000.0], &[], Lumping::RowSum).unwrap();
        let nodes = mesh.points().iter().enumerate();
        let held = nodes.filter(|(_, x)| x.y >= 0.03 - 1e-9).map(|(node, _)| node as u32).collect();
        let jaw = |side: f64| {
            let law = ContactLaw::coulomb(PENALTY, 0.15, 1e8).unwrap();
            let shape = ToolShape::RoundedBox(RoundedBox { half: [5e-3, 10e-3, 4e-3], radius: 1.5e-3 });
            let at = Point3::new(0.0, -0.02, 0.019 * side);
            Tool::new(shape, at, Matrix3::identity(), Vector3::new(0.0, 0.0, -side), law).unwrap()
        };
        Body { volume, surface, mass, held, jaws: [jaw(1.0), jaw(-1.0)] }
    }

    pub fn nodes(&self) -> usize {
        self.mass.len()
    }

    pub fn elements(&self) -> usize {
        self.volume.weights().len()
    }

    pub fn force<'a>(&'a self, laws: &'a [Law]) -> InternalForce<'a> {
        let body = ExplicitBody { volume: &self.volume, laws, region: &[], axes: &[], groups: None };
        InternalForce::new(body, LanePath::best()).unwrap()
    }

    pub fn prescribed(&self) -> Vec<Prescribed<'static>> {
        let node = |&node| (0..3).map(move |axis| Prescribed { node, axis, motion: &|_| 0.0 });
        self.held.iter().flat_map(node).collect()
    }

    pub fn contact(&self) -> ContactSurface<'_> {
        ContactSurface::new(&self.surface)
    }

    /// Starts from rest, at 0.9 of the critical step.
    pub fn motion<'a, 'b>(
        &'b self,
        force: &'b mut InternalForce<'a>,
        prescribed: &'b [Prescribed<'b>],
        contact: &'b ContactSurface<'b>,
    ) -> Dynamics<'a, 'b> {
        let zeros = vec![Vector3::zeros(); self.nodes()];
        let held = |k: usize| self.held.contains(&((k / 3) as u32));
        let springs = Springs { surface: &self.surface, modulus: PENALTY, damping: 0.0 };
        let known =
            critical_step_touching(force, &self.mass, &zeros, |k| !held(k), &[springs], LANCZOS).unwrap();
        let mass = 0.1 * self.mass.iter().sum::<f64>();
        let moving = [0, 1].map(|k| {
            let drive = Drive::Force(4.0);
            MovingTool { tool: &self.jaws[k], drive, over: 2.0, curve: None, mass, damping: 0.0 }
        });
        let params = DynamicsParams {
            dt: 0.9 * known.dt,
            damping: 0.0,
            critical: LANCZOS,
            recheck: 0,
            known: Some(known),
        };
        let tools = Tools::new(contact, &moving, &zeros).unwrap();
        Dynamics::new(force, &self.mass, prescribed, params, zeros.clone(), zeros)
            .and_then(|motion| motion.with_tools(tools))
            .unwrap()
    }
}
