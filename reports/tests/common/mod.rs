//! An artificial study that fills every table and every figure, from power laws with fixed perturbations and
//! without random numbers.

mod bean;

use bean::{bean, grasped};
use records::{
    Check, Failure, Family, Machine, PlanEntry, Program, Provenance, Purpose, Record, RunSet, SceneHash,
    Status,
};

/// Basis, support scale, dilation and integration; empty or 0 if absent.
type Settings = (&'static str, f64, &'static str, &'static str);

const PLAIN: Settings = ("", 0.0, "", "");
const LINEAR: Settings = ("linear", 1.6, "", "");

fn base(case: &str, method: &str, family: Family, variant: &str, settings: Settings) -> Record {
    let (basis, support_scale, dilation, integration) = settings;
    let text = |value: &str| (!value.is_empty()).then(|| value.to_string());
    Record {
        case: case.into(),
        method: method.into(),
        series: method.into(),
        family,
        variant: variant.into(),
        basis: text(basis),
        support_scale: (support_scale > 0.0).then_some(support_scale),
        dilation: text(dilation),
        integration: text(integration),
        poisson: 0.3,
        unit: "1".into(),
        statistic: "value".into(),
        ..Record::default()
    }
}

fn push(set: &mut RunSet, run: &Record, quantity: &str, unit: &str, value: f64) {
    set.records.push(Record { unit: unit.into(), value, ..run.clone() }.named(quantity));
}

fn push_times(set: &mut RunSet, run: &Record, phases: &[(&str, f64)]) {
    let total: f64 = phases.iter().map(|p| p.1).sum();
    for (phase, time) in phases.iter().chain([&("total", total)]) {
        for (statistic, value) in [("median", *time), ("spread", 0.05 * time), ("min", 0.97 * time)] {
            let (quantity, unit) = ("time".to_string(), "s".to_string());
            let (phase, statistic) = (phase.to_string(), statistic.to_string());
            set.records.push(Record { quantity, unit, phase, statistic, value, ..run.clone() });
        }
    }
    push(set, run, "memory", "B", 4e6 + 900.0 * run.nodes as f64);
}

/// Method id, family, variant, settings, displacement order, error at h = 1 mm for nu = 0.3, whether the
/// method locks, and cost per unknown.
type Method = (&'static str, Family, &'static str, Settings, f64, f64, bool, f64);

const METHODS: [Method; 8] = [
    ("tet4", Family::Fem, "tet4", PLAIN, 2.0, 2e-3, true, 1.0),
    ("tet4-nodal", Family::Fem, "tet4", ("", 0.0, "nodal-mean", ""), 2.0, 3e-3, false, 1.4),
    ("tet10", Family::Fem, "tet10", PLAIN, 3.0, 3e-5, false, 3.0),
    ("hex8", Family::Fem, "hex8", PLAIN, 2.0, 8e-4, true, 1.2),
    ("hex20", Family::Fem, "hex20", PLAIN, 3.0, 1e-5, false, 4.0),
    ("efg", Family::Efg, "cubic-spline", LINEAR, 2.0, 4e-4, false, 8.0),
    (
        "efg-smoothed",
        Family::Efg,
        "cubic-spline",
        ("linear", 1.6, "", "cell-smoothed"),
        2.0,
        9e-4,
        false,
        5.0,
    ),
    ("efg-quadratic", Family::Efg, "wendland-c2", ("quadratic", 2.0, "", ""), 3.0, 2e-5, false, 20.0),
];

fn solid(set: &mut RunSet, case: &str, ratios: &[f64], size: f64) {
    for (m, &(id, family, variant, parameters, order, error, locks, cost)) in METHODS.iter().enumerate() {
        for &poisson in ratios {
            for level in 1..=4u32 {
                let h = size / 2f64.powi(level as i32 - 1);
                let nodes = (6400.0 * (1e-3 / h).powi(3)) as u64 + 45;
                let run = Record {
                    poisson,
                    level,
                    nodes,
                    elements: 5 * nodes,
                    points: 20 * nodes,
                    dofs: 3 * nodes,
                    spacing: h,
                    ..base(case, id, family, variant, parameters)
                };
                let wiggle = 1.0 + 0.06 * ((level as f64) * 1.7 + m as f64).sin();
                let stiff = 1.0 / (1.0 - 2.0 * poisson);
                let lock = if locks { (stiff / 2.5).powf(0.7) } else { 1.0 };
                let l2 = (error * (h / 1e-3).powf(order) * wiggle * lock).min(0.93);
                push(set, &run, "l2", "1", l2);
                push(
                    set,
                    &run,
                    "energy",
                    "1",
                    (4.0 * error.sqrt() * (h / 1e-3).powf(order - 1.0) * 0.2 * wiggle * lock).min(0.98),
                );
                push(set, &run, "pressure", "1", 30.0 * l2 * lock);
                push(set, &run, "tip", "1", 1.0 - 0.9 * l2);
                push(set, &run, "max", "m", 5e-3 * (1.0 - 0.7 * l2));
                push(set, &run, "peak-error", "1", 0.7 * l2);
                for (axis, share) in [("rms-x", 0.4), ("rms-y", 0.3), ("rms-z", 0.86), ("rms", 1.0)] {
                    push(set, &run, axis, "m", share * l2 * 3e-3);
                }
                let work = cost * 1e-6 * nodes as f64;
                let factor = 2e-9 * cost * (nodes as f64).powf(1.7);
                push_times(
                    set,
                    &run,
                    &[
                        ("prepare", 2.0 * work),
                        ("assemble", 3.0 * work),
                        ("factor", factor),
                        ("solve", 0.5 * work),
                        ("transfer", 0.02 * work),
                    ],
                );
            }
        }
    }
}

fn patch(set: &mut RunSet) {
    for (method, family, variant, parameters, error) in [
        ("tet4", Family::Fem, "tet4", PLAIN, 2e-15),
        ("hex20", Family::Fem, "hex20", PLAIN, 7e-15),
        ("efg-smoothed", Family::Efg, "cubic-spline", LINEAR, 3e-15),
        ("efg-gauss", Family::Efg, "cubic-spline", LINEAR, 1.4e-3),
    ] {
        let run = Record {
            purpose: Purpose::Patch,
            nodes: 216,
            spacing: 0.2,
            ..base("patch-displacement", method, family, variant, parameters)
        };
        push(set, &run, "l2", "1", error);
    }
}

fn clouds(set: &mut RunSet) {
    for (k, kernel) in
        ["cubic-spline", "quartic-spline", "gaussian", "wendland-c2", "wendland-c4", "regularised"]
            .iter()
            .enumerate()
    {
        for dilatation in [1.2, 1.6, 2.0, 2.5] {
            for (basis, from) in [("linear", 1.2), ("quadratic", 1.8)] {
                if dilatation < from {
                    continue;
                }
                let run = Record {
                    nodes: 332,
                    spacing: 5e-3,
                    ..base(
                        "cloud-quality",
                        &format!("efg-{kernel}"),
                        Family::Efg,
                        kernel,
                        (basis, dilatation, "", ""),
                    )
                };
                let neighbours = 8.5 * f64::powi(dilatation, 3);
                let condition =
                    (30.0 + 60.0 * k as f64) * if basis == "linear" { 1.0 } else { 90.0 } / dilatation;
                push(set, &run, "neighbours-min", "1", (0.4 * neighbours).floor());
                push(set, &run, "neighbours-mean", "1", neighbours);
                push(set, &run, "neighbours-max", "1", (1.7 * neighbours).floor());
                push(set, &run, "condition-median", "1", condition);
                push(set, &run, "condition-max", "1", 7.0 * condition);
                push(set, &run, "fallbacks-enlarged", "1", if dilatation < 1.5 { 12.0 } else { 0.0 });
            }
        }
    }
}

fn kidney(set: &mut RunSet) {
    let case = "kidney-paper";
    let mut displacement = |(method, series): (&str, &str),
                            family: Family,
                            variant: &str,
                            settings: Settings,
                            nodes: u64,
                            error: f64,
                            time: f64| {
        let spacing = 32e-3 / (nodes as f64).cbrt();
        let run = Record {
            purpose: Purpose::Published,
            published: "saghaei-2016".into(),
            series: series.into(),
            poisson: 0.495,
            nodes,
            spacing,
            dofs: 3 * nodes,
            ..base(case, method, family, variant, settings)
        };
        for (axis, max, rms) in [("x", 4.1e-3, 1.1), ("y", 2.2e-3, 0.7), ("z", 7.9e-3, 2.1)] {
            push(set, &run, &format!("max-{axis}"), "m", max);
            push(set, &run, &format!("rms-{axis}"), "m", rms * error);
        }
        push(set, &run, "rms", "m", 2.47 * error);
        push(set, &run, "relative-rms", "1", 600.0 * error);
        push(set, &run, "tool-force-error", "1", 200.0 * error);
        push(set, &run, "tool-force-error-2", "1", 210.0 * error);
        for (statistic, part) in [("median", 0.06), ("p99", 0.08), ("p99.9", 0.2)] {
            set.records.push(Record {
                quantity: "time".into(),
                unit: "s".into(),
                phase: "repeated".into(),
                statistic: statistic.into(),
                value: part * time,
                ..run.clone()
            });
        }
        push_times(
            set,
            &run,
            &[
                ("prepare", 0.4 * time),
                ("assemble", 0.2 * time),
                ("factor", 0.3 * time),
                ("solve", 0.06 * time),
                ("transfer", 0.04 * time),
            ],
        );
    };
    displacement(("tet4", "tet4"), Family::Fem, "tet4", PLAIN, 1331, 0.9e-3, 0.05);
    displacement(("tet10", "tet10"), Family::Fem, "tet10", PLAIN, 9000, 0.05e-3, 1.4);
    for (i, nodes) in [83u64, 166, 332, 665, 1331].into_iter().enumerate() {
        for kernel in ["cubic-spline", "wendland-c2"] {
            let error = 1.6e-3 / (i + 1) as f64 * if kernel == "cubic-spline" { 1.0 } else { 0.93 };
            let series = format!("efg-{kernel}");
            displacement(
                (&format!("{series}-{nodes}"), &series),
                Family::Efg,
                kernel,
                LINEAR,
                nodes,
                error,
                0.008 * (nodes as f64 / 83.0).powf(1.3),
            );
        }
    }
    kidney_transfers(set, case);
}

fn kidney_transfers(set: &mut RunSet, case: &str) {
    type Scheme = (&'static str, Option<u64>, Option<f64>, f64);
    let schemes: [Scheme; 6] = [
        ("nearest", None, None, 0.9e-3),
        ("inverse-distance", Some(4), None, 0.5e-3),
        ("shepard", None, Some(1.6), 0.6e-3),
        ("mls-linear", None, Some(1.6), 2e-18),
        ("thin-plate", None, None, 1e-18),
        ("barycentric", None, None, 0.69e-3),
    ];
    for (i, (scheme, neighbours, support_scale, error)) in schemes.into_iter().enumerate() {
        for (from, scale) in [("linear", 1.0), ("bump", 0.8), ("efg-cubic-spline-83", 0.6)] {
            let run = Record {
                purpose: Purpose::Published,
                published: "saghaei-2016".into(),
                from: Some(from.into()),
                neighbours,
                support_scale,
                poisson: 0.495,
                nodes: 83,
                points: 1331,
                ..base(case, scheme, Family::Interp, scheme, PLAIN)
            };
            let added = if from == "linear" { 0.0 } else { 0.2e-3 };
            for (axis, share) in [("rms-x", 0.5), ("rms-y", 0.3), ("rms-z", 0.8), ("rms", 1.0)] {
                push(set, &run, axis, "m", share * (scale * error + added));
            }
            push_times(set, &run, &[("prepare", 2e-4 * (i + 1) as f64), ("transfer", 1.2e-5)]);
        }
    }
}

/// Adds a tool closing on a block: two methods step by step, a finer level of one method, and a reference
/// with its uncertainty.
fn grasp(set: &mut RunSet) {
    for (method, family, nodes, stiffness) in [
        ("hex8", Family::Fem, 225, 1.08),
        ("hex8", Family::Fem, 1377, 1.03),
        ("efg", Family::Efg, 225, 0.97),
        ("measured", Family::Reference, 0, 1.0),
    ] {
        for step in 0..=40u32 {
            let at = |statistic: &str, quantity: &str, unit: &str, value: f64| {
                let record = Record {
                    nodes,
                    spacing: if nodes == 0 { 0.0 } else { 0.1 / (nodes as f64).cbrt() },
                    unit: unit.into(),
                    step: Some(step.into()),
                    statistic: statistic.into(),
                    value,
                    ..base("grasp", method, family, method, PLAIN)
                };
                record.named(quantity)
            };
            let closure = 0.25e-3 * f64::from(step);
            let force = stiffness * (120.0 * closure + 9e3 * closure * closure);
            set.records.push(at("value", "closure", "m", closure));
            set.records.push(at("value", "tool-force", "N", force));
            if family == Family::Reference {
                set.records.push(at("low", "tool-force", "N", 0.92 * force));
                set.records.push(at("high", "tool-force", "N", 1.08 * force));
                continue;
            }
            let strain = stiffness * (60.0 * closure.powi(2) + 3e3 * closure.powi(3));
            set.records.push(at("value", "time", "s", 0.05 * f64::from(step)));
            for (quantity, share) in [
                ("strain-energy", 1.0),
                ("kinetic-energy", 0.02),
                ("contact-energy", 0.03),
                ("friction-dissipation", 0.1),
                ("damping-dissipation", 0.0),
                ("external-work", 1.15),
            ] {
                set.records.push(at("value", quantity, "J", share * strain));
            }
        }
    }
}

fn check(
    case: &str,
    method: &str,
    metric: &str,
    value: Option<f64>,
    bound: &str,
    status: Status,
    reason: &str,
) -> Check {
    Check {
        case: case.into(),
        method: method.into(),
        metric: metric.into(),
        value,
        bound: bound.into(),
        capped: true,
        status,
        reason: reason.into(),
        runs: Vec::new(),
        at: String::new(),
    }
}

/// Provenance of the artificial numbers.
fn provenance() -> Provenance {
    Provenance {
        source: "study.toml".into(),
        set: Vec::new(),
        format: records::FORMAT,
        program: Program {
            version: "0.1.0".into(),
            commit: "0123456789ab".into(),
            dirty: false,
            rustc: "1.95.0".into(),
            target: "x86_64-unknown-linux-gnu".into(),
            features: "fxsr,sse,sse2".into(),
            profile: "release".into(),
        },
        machine: Machine {
            cpu: "Example CPU <model> & co".into(),
            instructions: "avx2,fma".into(),
            threads: 2,
            load: Some(0.25),
            quiet: Some(true),
            model: "family 25, model 17, stepping 1".into(),
            clock: Some(2.45),
            at_once: 1,
        },
        scenes: vec![SceneHash {
            case: "pure-bending".into(),
            blake3: "ab".repeat(32),
            title: "A beam | bent <purely>".into(),
        }],
    }
}

/// The whole study.
pub fn study() -> RunSet {
    let mut set = RunSet { provenance: provenance(), ..RunSet::default() };
    solid(&mut set, "pure-bending", &[0.0, 0.3, 0.45, 0.495, 0.4999], 10e-3);
    solid(&mut set, "cantilever", &[0.3], 8e-3);
    solid(&mut set, "thick-sphere", &[0.3, 0.495], 6e-3);
    patch(&mut set);
    clouds(&mut set);
    kidney(&mut set);
    grasp(&mut set);
    set.checks = vec![
        check("patch-displacement", "tet4", "l2", Some(2e-15), "at most 1e-12", Status::Pass, ""),
        check(
            "patch-displacement",
            "efg-gauss",
            "l2",
            Some(1.4e-3),
            "at most 1e-12",
            Status::KnownFailure,
            "Plain Gauss quadrature doesn't integrate meshfree shape functions exactly.",
        ),
        check(
            "pure-bending",
            "tet4",
            "order-l2",
            Some(1.4),
            "at least 1.85",
            Status::Fail,
            "It locks | at ν = 0.495.",
        ),
        check(
            "thick-sphere",
            "hex8",
            "pressure",
            None,
            "at most 0.1",
            Status::NotRun,
            "No reference pressure.",
        ),
    ];
    set.failures = vec![Failure {
        case: "cantilever".into(),
        method: "efg-tight".into(),
        reason: "Too few neighbours at <0, 0, 1>: 3 of 4 & no fallback.".into(),
        carried: None,
        ..Failure::default()
    }];
    for (stage, ran, why) in [
        ("contact search", false, "no tool"),
        ("assemble", true, "always"),
        ("transfer", false, "output at nodes of a Kronecker basis"),
    ] {
        set.plans.push(PlanEntry {
            case: "cantilever".into(),
            method: "tet4".into(),
            stage: stage.into(),
            ran,
            why: why.into(),
        });
    }
    set.fields = vec![
        grasped(("efg", Family::Efg), 0.0),
        grasped(("tet4", Family::Fem), 3e4),
        bean(("efg-83", Family::Efg), "EFG, 83 nodes", 24, 7e-3),
        bean(("tet4", Family::Fem), "FE tet4, 1331 nodes", 24, 9e-3),
    ];
    for record in &mut set.records {
        let settings =
            (&record.basis, record.support_scale, &record.dilation, &record.integration, &record.from);
        let size = (record.poisson.to_bits(), record.level, record.nodes);
        record.run = format!("{} {} {} {settings:?} {size:?}", record.case, record.method, record.variant);
    }
    set
}
