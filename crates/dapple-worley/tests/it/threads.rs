//! Tests that any number of threads gives the same bits.

use dapple_hash::Seed;
use dapple_raster::{Raster, Window};
use dapple_worley::{Combination, FeatureView, Metric, Octaves, Plane, Worley, WorleyError};
use glam::DVec2;

/// Checks that an image has the same bits on 1, 2 and 7 threads.
fn is_the_same_with_any_number_of_threads<T: PartialEq + Send>(
    what: &str,
    picture: impl Fn() -> T + Sync,
) {
    let pictures = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(&picture)
    });
    assert!(pictures[0] == pictures[1], "{what}: one and two threads");
    assert!(pictures[0] == pictures[2], "{what}: one and seven threads");
}

/// Returns windows of several bands and blocks, with small and with large pixels.
fn windows() -> Result<[Window; 2], WorleyError> {
    Ok([
        Window::new(DVec2::new(-3.0, 1e5), DVec2::new(9.0, 7.0), [700, 333])?,
        Window::new(DVec2::new(0.5, -0.5), DVec2::new(400.0, 450.0), [300, 451])?,
    ])
}

#[test]
fn threads_do_not_change_a_bit_of_values() -> Result<(), WorleyError> {
    for window in windows()? {
        // A sum and a largest term: the parts of a window that threads take do not depend on the metric.
        for metric in [Metric::Euclidean, Metric::Chebyshev] {
            let worley = Worley::<2>::new(Seed(121)).with_metric(metric)?;
            let texture = worley.combine(Combination::TWO_F3_MINUS_F2_MINUS_F1);
            is_the_same_with_any_number_of_threads("values", || {
                let mut values = Raster::filled(window.size, -1.0).unwrap();
                let view = values.view_mut();
                texture
                    .render_plane(&Plane::default(), &window, view)
                    .unwrap();
                values.map(|value| value.to_bits())
            });
        }
        let texture = Worley::<3>::new(Seed(121)).combine(Combination::F1);
        let fractal = texture.fractal(Octaves::default())?;
        let slice = Plane::slice([0.0, 0.0, 0.3].into());
        is_the_same_with_any_number_of_threads("a fractal", || {
            let mut values = Raster::filled(window.size, -1.0).unwrap();
            fractal
                .render_plane(&slice, &window, values.view_mut())
                .unwrap();
            values.map(|value| value.to_bits())
        });
    }
    Ok(())
}

#[test]
fn threads_do_not_change_a_bit_of_features_and_gradients() -> Result<(), WorleyError> {
    let worley = Worley::<2>::new(Seed(122)).with_density(1.0)?;
    let texture = worley.combine(Combination::F2_MINUS_F1);
    for window in windows()? {
        is_the_same_with_any_number_of_threads("features", || {
            let mut distances = Raster::filled(window.size, -1.0).unwrap();
            let mut vectors = Raster::filled(window.size, [0.0; 2]).unwrap();
            let mut ids = Raster::filled(window.size, 0).unwrap();
            let mut views = [(); 3].map(|()| FeatureView::default());
            views[0].distance = Some(distances.view_mut());
            views[1].vector = Some(vectors.view_mut());
            views[2].id = Some(ids.view_mut());
            worley
                .render_features(&Plane::default(), &window, views)
                .unwrap();
            let vectors = vectors.map(|vector| vector.map(f32::to_bits));
            (distances.map(|distance| distance.to_bits()), vectors, ids)
        });
        is_the_same_with_any_number_of_threads("gradients", || {
            let mut gradients = Raster::filled(window.size, [0.0; 2]).unwrap();
            let view = gradients.view_mut();
            texture
                .render_gradient(&Plane::default(), &window, view)
                .unwrap();
            gradients.map(|gradient| gradient.map(f32::to_bits))
        });
    }
    Ok(())
}
