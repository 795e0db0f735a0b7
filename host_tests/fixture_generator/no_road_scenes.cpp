#include "no_road_scenes.hpp"

#include "street.hpp"

namespace fixtures {
namespace {

constexpr double huge = 60.0;  // half size of surfaces that must fill the view

Scene nothing(Lcg& random) {
    Scene scene;
    scene.road.present = false;
    scene.sky_grey = random.uniform(150, 225);
    return scene;
}

void add_panel(Scene& scene, const cv::Vec3d& centre, const cv::Vec3d& half_size, double yaw, const Texture& texture) {
    scene.solids.push_back({Shape::box, centre, half_size, heading_of(yaw), texture});
}

}  // namespace

Scene wall_ahead(Lcg& random) {
    Scene scene = nothing(random);
    const Texture bricks = surface_texture(random.uniform(90, 150), 1.0, random);
    const double distance = random.uniform(2.5, 9.0);
    add_panel(scene, {distance + 1, 0, 0}, {1, huge, huge}, random.uniform(-0.15, 0.15), bricks);
    return scene;
}

Scene side_wall(Lcg& random) {
    Scene scene = nothing(random);
    const double side = random.chance(0.5) ? 1.0 : -1.0, distance = random.uniform(1.0, 2.5);
    const Texture bricks = surface_texture(random.uniform(90, 150), 1.0, random);
    add_panel(scene, {50, side * (distance + 1), 0}, {100, 1, huge}, 0.0, bricks);
    return scene;
}

// The ceiling of a car park or tunnel; what is below is too dark to match.
Scene ceiling(Lcg& random) {
    Scene scene = nothing(random);
    scene.sky_grey = 12.0;
    const double above = random.uniform(0.8, 2.0);  // over the camera
    add_panel(scene, {50, 0, 1.5 + above + 0.5}, {150, huge, 0.5}, 0.0, surface_texture(100, 1.0, random));
    return scene;
}

// Bars near by, a wall far behind them; both go on below the view, so there is no ground.
Scene fence(Lcg& random) {
    Scene scene = nothing(random);
    const double distance = random.uniform(2.5, 5.0), pitch = random.uniform(0.11, 0.30);
    const double half_width = random.uniform(0.02, 0.05), yaw = random.uniform(-0.1, 0.1);
    const double background = random.uniform(25, 60);
    add_panel(scene, {background, 0, 0}, {0.5, huge, huge}, 0.0, surface_texture(140, 1.0, random));
    const Texture paint = surface_texture(random.uniform(50, 90), 0.8, random);
    for (double y = -1.2 * distance; y < 1.2 * distance; y += pitch) {
        Texture bar = paint;
        bar.seed = static_cast<std::uint32_t>(random.next());
        add_panel(scene, {distance + yaw * y, y, 0}, {0.02, half_width, 10}, 0.0, bar);
    }
    for (const double z : {-0.6, 0.5, 1.6, 2.7})
        add_panel(scene, {distance + 0.05, 0, z}, {0.02, 1.2 * distance, 0.04}, yaw, paint);
    return scene;
}

Scene lorry_back(Lcg& random) {
    Scene scene = nothing(random);
    const double grey = random.uniform(110, 190), contrast = random.uniform(0.35, 0.8);
    Texture door = surface_texture(grey, contrast, random);
    door.pattern = Pattern::vehicle_rear;
    const double distance = random.uniform(1.8, 3.5);
    const double aside = random.uniform(-0.3, 0.3), yaw = random.uniform(-0.03, 0.03);
    // As wide as the view at this distance: nothing else is to be seen, as in a queue with the bumper against it.
    add_panel(scene, {distance + 4, aside, 1.5}, {4, distance, 0.8 * distance}, yaw, door);
    add_panel(scene, {distance - 0.06, 0, 1.5 - 0.3 * distance}, {0.05, distance, 0.08}, 0.0, surface_texture(60, 0.8, random));
    return scene;
}

Scene bonnet_only(Lcg& random) {
    Scene scene = nothing(random);
    Bonnet bonnet = own_bonnet(random);
    bonnet.drop = random.uniform(0.30, 0.50);
    bonnet.tilt = random.uniform(-0.02, 0.12);
    bonnet.length = random.uniform(1.4, 1.75);
    scene.bonnet = bonnet;
    return scene;
}

}  // namespace fixtures
