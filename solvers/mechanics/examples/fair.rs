use fem::{SurfaceRule, VolumeRule};
use geometry::CellKind;
use geometry::generate::{kidney_mesh, raise_order};
use mechanics::*;
use shape::DilationGroups;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let (kind, n, dil) = (args[1].as_str(), args[2].parse::<usize>().unwrap(), args[3].as_str());
    let kind = match kind {
        "tet4" => CellKind::Tet4,
        "tet10" => CellKind::Tet10,
        "hex8" => CellKind::Hex8,
        _ => CellKind::Hex20,
    };
    let friction: f64 = args.get(4).map_or(0.15, |a| a.parse().unwrap());
    let mesh = if n == 0 {
        let m = geometry::msh::read(std::path::Path::new("/work/main/cases/kidney-1331.msh"), 1e-3).unwrap();
        if kind == CellKind::Tet10 { raise_order(&m) } else { m }
    } else {
        kidney_mesh(kind, n).unwrap()
    };
    let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
    let element = fem::element_dilation(&mesh, &VolumeRule::STANDARD).unwrap();
    let nodal = if dil == "nodal" { Some(DilationGroups::nodal(&volume).unwrap()) } else { None };
    let pressure = fem::pressure_rows(&mesh, &VolumeRule::STANDARD).unwrap();
    let dilation = match dil {
        "standard" => Dilation::Standard,
        "element" => Dilation::Groups(&element),
        "nodal" => Dilation::Groups(nodal.as_ref().unwrap()),
        _ => Dilation::Mixed(&pressure),
    };
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.495).unwrap())];
    let fixed: Vec<FixedDof> = (0..mesh.points().len() as u32)
        .filter(|&i| mesh.points()[i as usize].y >= 0.03)
        .flat_map(|node| (0..3).map(move |axis| FixedDof { node, axis, value: 0.0 }))
        .collect();
    let rule = SurfaceRule::STANDARD;
    let surface = fem::surface_rows(&mesh, &mesh.boundary(), &rule).unwrap();
    let contact = ContactSurface::new(&surface);
    let law = if friction > 0.0 {
        ContactLaw::coulomb(0.5e9, friction, 0.1e9).unwrap()
    } else {
        ContactLaw::frictionless(0.5e9).unwrap()
    };
    let jaw = |sign: f64| {
        Tool::new(
            ToolShape::RoundedBox { half: [5e-3, 10e-3, 4e-3], radius: 1.5e-3 },
            Point3::new(0.0, 0.0, sign * 19e-3),
            Matrix3::identity(),
            Vector3::new(0.0, 0.0, -sign),
            law,
        )
        .unwrap()
    };
    let (up, low) = (jaw(1.0), jaw(-1.0));
    let tools = [
        DrivenTool { tool: &up, drive: Drive::Closure(7e-3) },
        DrivenTool { tool: &low, drive: Drive::Closure(7e-3) },
    ];
    let problem = StaticProblem {
        nodes: mesh.points(),
        solid: Solid { volume: &volume, laws: &laws, region: &[], dilation },
        loads: &[],
        fixed: &fixed,
        held: &[],
        contact: Some(&contact),
        tools: &tools,
    };
    let params = StaticParams {
        steps: args.get(5).map_or(10, |a| a.parse().unwrap()),
        smallest: 1.0 / 64.0,
        newton: NewtonParams { tolerance: 1e-9, iterations: 25 },
        augmentations: 0,
    };
    let start = std::time::Instant::now();
    println!("{} nodes {} cells {} points", mesh.points().len(), mesh.cell_count(), volume.weights().len());
    let path = solve_static(&problem, &params, |s, _, _| {
        println!(
            "{:.3} F {:.5} {:.5} N its {} J {:.3} lens {:?}",
            s.time,
            s.tools[0].force.z,
            s.tools[1].force.z,
            s.iterations.len(),
            s.smallest,
            s.iterations
                .iter()
                .map(|i| format!("{:.0e}/{:.2}{}", i.residual, i.length, if i.definite { "" } else { "s" }))
                .collect::<Vec<_>>()
                .join(" ")
        );
    })
    .unwrap();
    println!(
        "{:?} cut {} {:?} time {:?}",
        path.failure.map(|f| f.to_string()),
        path.cut_back,
        path.counts,
        start.elapsed()
    );
}
