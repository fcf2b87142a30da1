//! A sphere and a floor with the materials of recipes. Change `assets/rock.toml` while it runs.

use bevy::prelude::*;
use bevy_dapple::RecipePlugin;

fn main() {
    let files = AssetPlugin {
        file_path: concat!(env!("CARGO_MANIFEST_DIR"), "/assets").to_owned(),
        watch_for_changes_override: Some(true),
        ..AssetPlugin::default()
    };
    App::new()
        .add_plugins((DefaultPlugins.set(files), RecipePlugin))
        .add_systems(Startup, set_up)
        .add_systems(Update, turn)
        .run();
}

/// The mesh that turns.
#[derive(Component)]
struct Turning;

fn set_up(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    assets: Res<AssetServer>,
) -> Result {
    // Normal maps need tangents.
    let sphere = Sphere::new(1.0).mesh().uv(96, 48);
    let floor = Plane3d::default().mesh().size(8.0, 8.0).build();
    commands.spawn((
        Mesh3d(meshes.add(sphere.with_generated_tangents()?)),
        MeshMaterial3d::<StandardMaterial>(assets.load("rock.toml#material")),
        Transform::from_xyz(0.0, 1.0, 0.0),
        Turning,
    ));
    commands.spawn((
        Mesh3d(meshes.add(floor.with_generated_tangents()?)),
        MeshMaterial3d::<StandardMaterial>(assets.load("floor.toml#material")),
    ));
    commands.spawn((
        DirectionalLight::default(),
        Transform::from_xyz(3.0, 5.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.spawn((
        Camera3d::default(),
        Transform::from_xyz(0.0, 2.5, 4.5).looking_at(Vec3::Y * 0.7, Vec3::Y),
    ));
    Ok(())
}

fn turn(time: Res<Time>, mut meshes: Query<&mut Transform, With<Turning>>) {
    for mut mesh in &mut meshes {
        mesh.rotate_y(0.4 * time.delta_secs());
    }
}
