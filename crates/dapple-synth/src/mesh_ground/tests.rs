//! Squares on surfaces, beside samples that are walked to one by one.

use super::{MeshGround, MeshMemory};
use crate::ground::{Ground, Rows, Samples, Square};
use crate::{Orientation, Sweep};
use dapple_mesh::{Hierarchy, HierarchyOptions, Mesh, Surface, glam::DVec3};

fn spot() -> Option<Surface> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/data/meshes/spot.obj"
    );
    let text = std::fs::read_to_string(path).ok()?;
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                positions.push(DVec3::new(p[0], p[1], p[2]));
            }
            Some("f") => {
                let f: Vec<u32> = words
                    .map(|w| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1)
                    .collect();
                faces.push([f[0], f[1], f[2]]);
            }
            _ => {}
        }
    }
    Some(Surface::new(Mesh::new(positions, &faces).unwrap()).unwrap())
}

fn cpu() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split_whitespace()
        .next()
        .unwrap()
        .parse::<f64>()
        .unwrap()
        * 1e-9
}

#[test]
fn scratch_timing() {
    let surface = spot().unwrap();
    let n = 262_144;
    let t = cpu();
    let hierarchy = Hierarchy::new(
        &surface,
        &HierarchyOptions {
            n_sites: n,
            ..Default::default()
        },
    )
    .unwrap();
    println!("hierarchy {:?}", (cpu() - t));
    let orientation = Orientation::new(&surface, &hierarchy, &[]).unwrap();
    let sweep = Sweep::new(&hierarchy, &orientation, None).unwrap();
    let ground = MeshGround {
        surface: &surface,
        hierarchy: &hierarchy,
        orientation: &orientation,
        sweep: &sweep,
    };
    let t = cpu();
    let prepared = ground.prepare(0, Some(3), Some(3));
    println!("prepare {:?}", cpu() - t);
    let groups = ground.groups(0, &prepared);
    println!("groups {:?} {}", (cpu() - t), groups.iter().count());
    let column: Vec<f32> = (0..n * 3).map(|i| (i % 97) as f32 * 0.01).collect();
    let order = ground.order(0);
    let mut samples = Samples::default();
    let mut memory = MeshMemory::default();
    for (name, reads, order) in [
        ("same, sweep", 0, order.clone()),
        ("coarser, index", 1, (0..n as u32).collect()),
        ("same, index", 0, (0..n as u32).collect()),
    ] {
        samples.make_room(7, 3);
        let t = cpu();
        let mut sum = 0.0;
        let some = &order[..order.len() / 2];
        for &site in some {
            let square = Square {
                site,
                level: 0,
                reads,
                half: 3,
                rows: Rows::All,
            };
            ground.read(square, &prepared, &column, &mut samples, &mut memory);
            sum += samples.values[0];
        }
        println!(
            "{name}: {:.2} us {sum}",
            (cpu() - t) / some.len() as f64 * 1e6
        );
        let t = cpu();
        let mut total = 0;
        for &site in some {
            let around = if reads == 0 {
                &prepared.same
            } else {
                &prepared.coarser
            };
            around.as_ref().unwrap().collect(site, &mut memory.nearby);
            total += memory.nearby.records.len();
        }
        println!(
            "= collect: {:.2} us, {} sites",
            (cpu() - t) / some.len() as f64 * 1e6,
            total / some.len()
        );
        let t = cpu();
        for &site in some {
            let level = &hierarchy.levels()[reads];
            let square = Square {
                site,
                level: 0,
                reads,
                half: 3,
                rows: Rows::All,
            };
            memory.small.lay(
                &surface,
                hierarchy.sites().points()[site as usize],
                orientation.vectors()[site as usize],
                &square,
                level.spacing(),
            );
        }
        println!("= lay: {:.2} us", (cpu() - t) / some.len() as f64 * 1e6);
    }
}
