//! Tests of whole images: positions, lighting and errors.

use crate::{
    Camera, Cut, Environment, Light, Material, Mesh, Mirror, Object, Part, PreviewErrorKind, Scene,
    Shadows, Shape, Sky, Supersampling, Surface, Transform,
};
use core::f64::consts::PI;
use dapple_color::LinearRgb;
use dapple_mesh::rotation;
use dapple_raster::Raster;
use glam::{DQuat, DVec3};

const RED: LinearRgb = LinearRgb::new(1.0, 0.0, 0.0);
const WHITE: LinearRgb = LinearRgb::WHITE;

/// Returns a material function that emits one color regardless of the lights.
fn glowing(color: LinearRgb) -> impl Fn(&Surface) -> Material + Send + Sync {
    move |_| Material::matte(LinearRgb::BLACK).with_emission(color)
}

fn matte(color: LinearRgb) -> impl Fn(&Surface) -> Material + Send + Sync {
    move |_| Material::matte(color)
}

/// Returns a camera at z = 8 that looks at the origin, with y up.
fn front() -> Camera {
    Camera::look_at(DVec3::Z * 8.0, DVec3::ZERO)
}

/// Returns a camera above the origin that looks down, with -z up.
fn above() -> Camera {
    Camera::look_at(DVec3::Y * 8.0, DVec3::ZERO).with_up(DVec3::NEG_Z)
}

fn render(scene: &Scene<'_>, size: u32) -> Raster<LinearRgb> {
    scene.render([size; 2], Supersampling(1)).unwrap()
}

/// Returns the color at the center of the image.
fn middle(scene: &Scene<'_>) -> LinearRgb {
    render(scene, 1).pixels()[0]
}

/// Returns a scene with every kind of shape, light and material.
fn everything() -> Scene<'static> {
    let corners = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X];
    let mesh = Mesh::smooth(&corners, &[[0, 1, 2], [2, 1, 3], [1, 0, 3]]).unwrap();
    let rings = |surface: &Surface| {
        let ring = surface.position.length() * 8.0;
        Material::matte(LinearRgb::new(0.8, (ring - ring.floor()) as f32, 0.2))
            .with_specular(0.5, 20.0)
    };
    let bumps = |surface: &Surface| {
        let slope = (surface.position * 5.0).floor() - surface.position * 5.0 + 0.5;
        Material::matte(LinearRgb::gray(0.4)).with_bump(slope)
    };
    let mirror = |_: &Surface| Material::matte(WHITE).with_mirror(Mirror::Fresnel(0.3));
    let (start, sweep) = (0.0, 4.5);
    let soft = Shadows::Soft {
        radius: 0.1,
        rays: 5,
    };
    let sky = Sky {
        nadir: LinearRgb::BLACK,
        horizon: WHITE,
        zenith: LinearRgb::new(0.1, 0.2, 0.7),
    };
    Scene::new(Camera::look_at(DVec3::new(1.0, 2.0, 6.0), DVec3::ZERO))
        .with_object(Object::new(Shape::Plane, bumps).at(DVec3::NEG_Y))
        .with_object(
            Object::new(Shape::torus(1.0, 0.4), rings).with_cut(Cut::Sector { start, sweep }),
        )
        .with_object(Object::new(Shape::sphere(0.7), mirror).at(DVec3::new(2.0, 0.0, 0.0)))
        .with_object(Object::new(Shape::mesh(mesh), bumps).at(DVec3::new(-2.0, 0.0, 0.0)))
        .with_light(Light::directional(DVec3::new(1.0, 2.0, 1.0), WHITE).with_shadows(soft))
        .with_light(Light::point(
            DVec3::new(-3.0, 3.0, 3.0),
            LinearRgb::gray(0.5),
        ))
        .with_ambient(LinearRgb::gray(0.1))
        .with_environment(Environment::Sky(sky))
}

#[test]
fn picture_has_x_to_the_right_and_y_at_the_top() {
    let scene = Scene::new(front())
        .with_object(Object::new(Shape::sphere(0.5), glowing(RED)).at(DVec3::X * 2.0))
        .with_object(Object::new(Shape::sphere(0.5), glowing(WHITE)).at(DVec3::Y * 2.0));
    let picture = render(&scene, 9);
    let found = |color| picture.pixels().iter().position(|&pixel| pixel == color);
    // The field of view is 5.8 high at the origin, so 2 is three of nine pixels.
    assert_eq!(found(RED), Some(4 * 9 + 7), "right of the middle");
    assert_eq!(found(WHITE), Some(9 + 4), "above the middle");
}

#[test]
fn nearer_object_hides_the_farther_in_any_order() {
    let near = || Object::new(Shape::sphere(0.5), glowing(RED)).at(DVec3::Z);
    let far = || Object::new(Shape::sphere(1.0), glowing(WHITE)).at(DVec3::NEG_Z);
    let scenes = [[near(), far()], [far(), near()]];
    for objects in scenes {
        let mut scene = Scene::new(front());
        scene.objects.extend(objects);
        assert_eq!(middle(&scene), RED);
    }
}

#[test]
fn plane_is_lit_by_the_cosine_of_the_light() {
    let toward = DVec3::new(3.0, 4.0, 0.0);
    let scene = Scene::new(above())
        .with_object(Object::new(Shape::Plane, matte(LinearRgb::gray(0.5))))
        .with_light(Light::directional(toward, RED))
        .with_ambient(LinearRgb::new(0.0, 0.25, 0.0));
    let expected = LinearRgb::new(0.5 * 0.8, 0.125, 0.0);
    let color = middle(&scene);
    // The cosine is rounded once to `f32`, the color once more.
    assert!((color.r - expected.r).abs() < 1e-7, "{color:?}");
    assert_eq!((color.g, color.b), (expected.g, expected.b));
}

#[test]
fn bump_is_lit_by_the_tilted_normal_at_every_scale_and_rotation() {
    // The normal (-3, 4, 0) / 5 is lit perpendicularly, apart from the shadow of the bumps.
    let lit = |transform: Transform, bump: DVec3| {
        let look = move |_: &Surface| Material::matte(WHITE).with_bump(bump);
        let object = Object::new(Shape::Plane, look).with_transform(transform);
        let scene = Scene::new(above()).with_object(object);
        middle(&scene.with_light(Light::directional(DVec3::new(-3.0, 4.0, 0.0), WHITE))).r
    };
    let slope = DVec3::new(0.75, 0.0, 0.0);
    let plain = lit(Transform::default(), slope);
    // tan² is 9/16 for both the tilt and the light, so the shadow is 2 / (1 + √(1 + 9/16 · 9/16 / 8)).
    let shadow = 2.0 / (1.0 + (1.0_f32 + 81.0 / 2048.0).sqrt());
    assert!((plain - shadow).abs() < 1e-6, "{plain}, not {shadow}");
    let large = lit(Transform::default().with_scale(7.0), slope);
    assert!((large - plain).abs() < 1e-6, "{large}");
    // A quarter turn around y takes +z of the object to +x of the world.
    let turned = Transform::default().with_rotation(rotation(DVec3::Y, 0.5 * PI));
    let turned = lit(turned, DVec3::new(0.0, 0.0, 0.75));
    assert!((turned - plain).abs() < 1e-6, "{turned}");
}

#[test]
fn shadow_falls_where_an_object_is_before_the_light() {
    let scene = |shadows| {
        let light = Light::directional(DVec3::new(1.0, 1.0, 0.0), WHITE).with_shadows(shadows);
        Scene::new(above())
            .with_object(Object::new(Shape::Plane, matte(WHITE)))
            .with_object(
                Object::new(Shape::sphere(0.5), matte(WHITE)).at(DVec3::new(2.0, 2.0, 0.0)),
            )
            .with_light(light)
    };
    let lit = middle(&scene(Shadows::None)).r;
    assert!((lit - 0.5_f32.sqrt()).abs() < 1e-6, "without: {lit}");
    assert_eq!(middle(&scene(Shadows::Hard)), LinearRgb::BLACK, "hard");
    // A disk of tangent 0.5 is larger than the sphere of tangent 0.5 / √8, which covers about an eighth of it.
    let soft = middle(&scene(Shadows::Soft {
        radius: 0.5,
        rays: 200,
    }))
    .r / lit;
    assert!((soft - 0.875).abs() < 0.02, "soft: {soft}");
}

#[test]
fn point_light_is_not_blocked_by_what_is_behind_it() {
    let scene = |height: f64| {
        Scene::new(Camera::look_at(DVec3::new(0.0, 1.0, 8.0), DVec3::ZERO))
            .with_object(Object::new(Shape::Plane, matte(WHITE)))
            .with_object(Object::new(Shape::sphere(0.5), matte(WHITE)).at(DVec3::Y * height))
            .with_light(Light::point(DVec3::Y * 3.0, WHITE))
    };
    assert_eq!(middle(&scene(2.0)), LinearRgb::BLACK, "before the light");
    assert_eq!(middle(&scene(4.0)), WHITE, "behind the light");
}

#[test]
fn convex_shapes_throw_no_shadow_on_their_lit_side() {
    let octahedron = {
        let corners = [
            DVec3::X,
            DVec3::Y,
            DVec3::Z,
            -DVec3::X,
            -DVec3::Y,
            -DVec3::Z,
        ];
        let triangles = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]];
        Mesh::smooth(&corners, &triangles).unwrap()
    };
    for shape in [Shape::sphere(1.0), Shape::mesh(octahedron)] {
        // Far from the origin of the world, where positions are rounded to 1e-10.
        let place = DVec3::splat(1e5);
        let camera = Camera::look_at(place + DVec3::Z * 8.0, place);
        let lit = |shadows| {
            let light = Light::directional(DVec3::new(1.0, 1.0, 1.0), WHITE).with_shadows(shadows);
            let object = Object::new(shape.clone(), matte(WHITE)).at(place);
            render(
                &Scene::new(camera).with_object(object).with_light(light),
                40,
            )
        };
        let [with, without] = [lit(Shadows::Hard), lit(Shadows::None)];
        assert!(with.pixels().iter().any(|pixel| pixel.r > 0.9), "lit");
        assert_eq!(with, without, "{shape:?}");
    }
}

#[test]
fn mirror_shows_the_environment_of_the_mirrored_direction() {
    let look = |_: &Surface| Material::matte(WHITE).with_mirror(Mirror::Constant(1.0));
    let direction_of = |direction: DVec3| LinearRgb::from(direction.to_array().map(|x| x as f32));
    let scene = Scene::new(Camera::look_at(DVec3::new(-3.0, 4.0, 0.0), DVec3::ZERO))
        .with_object(Object::new(Shape::Plane, look))
        .with_environment(Environment::function(direction_of));
    let color = middle(&scene);
    // From (3, -4, 0) / 5 up to (3, 4, 0) / 5.
    let error = [color.r - 0.6, color.g - 0.8, color.b].map(f32::abs);
    assert!(error.iter().all(|&error| error < 1e-6), "{color:?}");
}

#[test]
fn mirror_shows_objects_as_often_as_it_may() {
    // A sphere hangs above a mirror, behind the eye. The environment is red.
    let mirror = |_: &Surface| Material::matte(LinearRgb::BLACK).with_mirror(Mirror::Constant(1.0));
    let scene = |bounces| {
        Scene::new(above())
            .with_object(Object::new(Shape::Plane, mirror))
            .with_object(Object::new(Shape::sphere(1.0), glowing(WHITE)).at(DVec3::Y * 12.0))
            .with_environment(Environment::Constant(RED))
            .with_bounces(bounces)
    };
    assert_eq!(middle(&scene(0)), RED, "without a bounce the environment");
    assert_eq!(middle(&scene(1)), WHITE, "with one the ball");
}

#[test]
fn cut_shows_the_inside_with_the_solid_texture() {
    let look = |surface: &Surface| {
        let light = surface.position.length() as f32;
        Material::matte(LinearRgb::BLACK).with_emission(match surface.part {
            Part::Cut => LinearRgb::gray(light),
            Part::Skin => RED,
        })
    };
    let (normal, offset) = (DVec3::Z, 0.25);
    let ball = Object::new(Shape::sphere(1.0), look).with_cut(Cut::HalfSpace { normal, offset });
    let color = middle(&Scene::new(front()).with_object(ball));
    // The position along the ray is rounded at the size of 8.
    assert!(
        (color.r - 0.25).abs() < 1e-6 && color.r == color.g,
        "{color:?}"
    );
}

#[test]
fn footprint_is_the_width_of_a_sample_in_units_of_the_object() {
    let look = |surface: &Surface| {
        let parts = [surface.footprint, surface.incidence, 0.0];
        Material::matte(LinearRgb::BLACK).with_emission(parts.map(|part| part as f32).into())
    };
    let tangent = 0.25;
    let camera = above().with_fov(2.0 * libm::atan(tangent));
    let plane = Object::new(Shape::Plane, look);
    let plane = plane.with_transform(Transform::default().with_scale(2.0));
    let scene = Scene::new(camera).with_object(plane);
    let picture = scene.render([5, 5], Supersampling(3)).unwrap();
    let color = picture.row(2)[2];
    // At distance 8, the image is 2 · 0.25 · 8 = 4 high and has 15 samples per column. The unit of the object is 2.
    // Samples next to the center are slightly farther away.
    let expected = 4.0 / 15.0 / 2.0;
    assert!((color.r / expected - 1.0).abs() < 2e-3, "{color:?}");
    assert!((color.g - 1.0).abs() < 2e-3, "{color:?}");
}

#[test]
fn supersampling_is_the_mean_of_the_finer_picture() {
    let scene = everything();
    let coarse = scene.render([8, 8], Supersampling(2)).unwrap();
    let fine = scene.render([16, 16], Supersampling(1)).unwrap();
    for row in 0..8 {
        for column in 0..8 {
            let at = |i: u32, j: u32| f64::from(fine.row(2 * row + j)[(2 * column + i) as usize].g);
            let mean = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4.0;
            assert_eq!(coarse.row(row)[column as usize].g, mean as f32);
        }
    }
}

#[cfg(feature = "rayon")]
#[test]
fn render_is_the_same_with_any_number_of_threads() {
    let pictures = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let picture = || everything().render([61, 47], Supersampling(2)).unwrap();
        let picture = pool.unwrap().install(picture);
        let bits = |color: &LinearRgb| color.to_array().map(f32::to_bits);
        picture.pixels().iter().map(bits).collect::<Vec<_>>()
    });
    assert_eq!(pictures[0], pictures[1], "one and two threads");
    assert_eq!(pictures[0], pictures[2], "one and seven threads");
}

#[test]
fn value_stability_picture() {
    let picture = everything().render([16, 12], Supersampling(2)).unwrap();
    let pinned = [[8, 0], [3, 5], [6, 6], [7, 7], [12, 6], [5, 10]].map(|[column, row]| {
        let color = picture.row(row)[column as usize];
        color.to_array().map(f32::to_bits)
    });
    let expected = [
        [0x3f2c_4fc8, 0x3f2c_ca15, 0x3f2f_2d9a],
        [0x3ee9_c736; 3],
        [0x3f4c_0202, 0x3ebf_1143, 0x3e85_4ed6],
        [0x3eab_0965, 0x3e6e_fbfd, 0x3e7c_3275],
        [0x3f2c_4bcc, 0x3f25_83fb, 0x3f2a_57f4],
        [0x3f01_536c; 3],
    ];
    assert_eq!(pinned, expected, "{pinned:#010x?}");
}

#[test]
fn textures_that_are_not_numbers_give_finite_pictures() {
    for bad in [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
    ] {
        let look = move |_: &Surface| Material {
            color: LinearRgb::gray(bad),
            emission: LinearRgb::new(bad, 0.0, -bad),
            bump: DVec3::splat(bad.into()),
            specular: bad,
            shininess: bad,
            mirror: Mirror::Fresnel(bad),
        };
        let mut scene = everything()
            .with_environment(Environment::function(move |_| LinearRgb::gray(bad)))
            .with_ambient(LinearRgb::gray(bad));
        scene.objects.push(Object::new(Shape::sphere(1.2), look));
        scene
            .lights
            .push(Light::point(DVec3::ONE, LinearRgb::gray(bad)));
        for pixel in render(&scene, 24).pixels() {
            assert!(
                pixel.to_array().iter().all(|part| part.is_finite()),
                "{bad}: {pixel:?}"
            );
        }
    }
}

#[test]
fn degenerate_places_give_finite_pictures() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::Y];
    let slivers = Mesh::smooth(&corners, &[[0, 1, 2], [0, 0, 3], [0, 1, 3]]).unwrap();
    let empty = Mesh::flat(&[], &[]).unwrap();
    // Place the eye and a light at the center of the sphere, on the plane and at a vertex.
    let scene = Scene::new(Camera::look_at(DVec3::ZERO, DVec3::X))
        .with_object(Object::new(Shape::Plane, matte(WHITE)))
        .with_object(Object::new(Shape::sphere(1.0), matte(WHITE)))
        .with_object(Object::new(Shape::mesh(slivers), matte(WHITE)))
        .with_object(Object::new(Shape::mesh(empty), matte(WHITE)))
        .with_light(Light::point(DVec3::ZERO, WHITE));
    let picture = render(&scene, 21);
    let mut parts = picture.pixels().iter().flat_map(|pixel| pixel.to_array());
    assert!(parts.all(f32::is_finite), "finite");
}

#[test]
fn bad_scenes_are_refused() {
    let nan = DVec3::new(0.0, f64::NAN, 0.0);
    let ball =
        |radius| Scene::new(front()).with_object(Object::new(Shape::sphere(radius), matte(RED)));
    let lit = |light| ball(1.0).with_light(light);
    let turned = |rotation| {
        let mut scene = ball(1.0);
        let object = Object::new(Shape::Plane, matte(RED));
        scene
            .objects
            .push(object.with_transform(Transform::default().with_rotation(rotation)));
        scene
    };
    let soft =
        |radius, rays| Light::point(DVec3::Z, RED).with_shadows(Shadows::Soft { radius, rays });
    let cases = [
        (
            Scene::new(Camera::look_at(DVec3::X, DVec3::X)),
            "the view of the camera has no direction",
        ),
        (
            Scene::new(Camera::look_at(DVec3::Y, DVec3::ZERO)),
            "the up of the camera, seen along its view, has no direction",
        ),
        (
            Scene::new(front().with_up(DVec3::ZERO)),
            "the up of the camera has no direction",
        ),
        (
            Scene::new(Camera::look_at(nan, DVec3::X)),
            "the eye of the camera is NaN, but it must be from -1e30 to 1e30",
        ),
        (
            Scene::new(front().with_fov(4.0)),
            "the field of view of the camera is 4, but it must be from 1e-9 to below π",
        ),
        (
            ball(-1.0),
            "the radius of a sphere is -1, but it must be from 1e-30 to 1e30",
        ),
        (
            lit(Light::directional(DVec3::ZERO, RED)),
            "the direction to a light has no direction",
        ),
        (
            lit(soft(1.0, 0)),
            "the number of shadow rays is 0, but it must be from 1 to 1024",
        ),
        (
            lit(soft(f64::NAN, 4)),
            "the radius of a light is NaN, but it must be from 0 to 1e30",
        ),
        (
            turned(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
            "the length of a rotation as a quaternion is 0, but it must be from 1e-9 to 1e9",
        ),
        (
            ball(1.0).with_bounces(99),
            "the number of bounces is 99, but it must be from 0 to 16",
        ),
    ];
    for (scene, text) in cases {
        let error = scene.render([4, 4], Supersampling(1)).unwrap_err();
        assert_eq!(error.to_string(), text);
    }
}

#[test]
fn bad_sizes_are_refused() {
    let scene = Scene::new(front());
    for size in [[0, 4], [4, 0], [u32::MAX; 2]] {
        let error = scene.render(size, Supersampling(1)).unwrap_err();
        assert!(
            matches!(error.kind(), PreviewErrorKind::Raster(_)),
            "{size:?}: {error}"
        );
    }
    for samples in [0, 65] {
        let error = scene.render([4, 4], Supersampling(samples)).unwrap_err();
        assert!(
            matches!(error.kind(), PreviewErrorKind::Range { .. }),
            "{error}"
        );
    }
}
