#include "street.hpp"

#include <algorithm>
#include <cmath>

namespace fixtures {
namespace {

constexpr double street_begin = -30.0, street_end = 220.0, kerb_height = 0.15;

void add_box(Scene& scene, const cv::Vec3d& low, const cv::Vec3d& high, const Texture& texture) {
    scene.solids.push_back({Shape::box, 0.5 * (low + high), 0.5 * (high - low), {1, 0}, texture});
}

// A box given by its length, width and the heights of its bottom and top, turned about the vertical.
void add_turned_box(Scene& scene, const cv::Vec3d& centre, const cv::Vec3d& half_size, double yaw, const Texture& texture) {
    scene.solids.push_back({Shape::box, centre, half_size, heading_of(yaw), texture});
}

void add_pavements(Scene& scene, const StreetStyle& style, Lcg& random) {
    const double top = scene.road.elevation(0.0, style.kerb) + kerb_height;
    for (const double side : {-1.0, 1.0}) {
        const Texture slabs = surface_texture(random.uniform(115, 150), 0.9, random);
        const double inner = side * style.kerb, outer = side * (style.kerb + 12.0);
        add_box(scene, {street_begin, std::min(inner, outer), -1.0}, {street_end, std::max(inner, outer), top}, slabs);
    }
}

void add_facades(Scene& scene, const StreetStyle& style, Lcg& random) {
    for (const double side : {-1.0, 1.0}) {
        double x = street_begin;
        while (x < street_end) {
            const double length = random.uniform(9, 22), gap = random.chance(0.25) ? random.uniform(2, 9) : 0.0;
            const double front = style.kerb + random.uniform(2.2, 4.0), height = random.uniform(6, 16);
            Texture wall = surface_texture(random.uniform(80, 170), 0.9, random);
            wall.pattern = Pattern::windows;
            add_box(scene, {x, std::min(side * front, side * (front + 8)), -0.5},
                    {x + length, std::max(side * front, side * (front + 8)), height}, wall);
            x += length + gap;
        }
    }
    if (!random.chance(0.6)) return;
    const double end_of_street = random.uniform(70, 200), height = random.uniform(8, 20);
    add_box(scene, {end_of_street, -60, -1}, {end_of_street + 10, 60, height},
            surface_texture(random.uniform(90, 150), 1.0, random));
}

void add_trees_and_poles(Scene& scene, const StreetStyle& style, Lcg& random) {
    for (const double side : {-1.0, 1.0})
        for (double x = random.uniform(3, 12); x < 90; x += random.uniform(7, 16)) {
            const double y = side * (style.kerb + random.uniform(0.4, 0.9));
            const bool tree = random.chance(0.6);
            const double radius = tree ? random.uniform(0.12, 0.25) : 0.06, half_height = tree ? 1.6 : 3.0;
            scene.solids.push_back({Shape::cylinder, {x, y, half_height}, {radius, 0, half_height}, {1, 0},
                                    surface_texture(random.uniform(50, 100), 1.0, random)});
            if (!tree) continue;
            const double crown = random.uniform(1.0, 1.7);
            scene.solids.push_back({Shape::sphere, {x, y, 3.0 + crown}, {crown, 0, 0}, {1, 0},
                                    surface_texture(random.uniform(50, 90), 1.8, random)});
        }
}

void add_parked(Scene& scene, const StreetStyle& style, Lcg& random) {
    for (const double side : {-1.0, 1.0})
        for (double x = random.uniform(1, 8); x < 80; x += random.uniform(5.2, 7.0)) {
            if (!random.chance(style.parked_share)) continue;
            const double y = side * (style.parked_offset + random.uniform(-0.1, 0.15));
            if (random.chance(0.15)) add_lorry(scene, x + 3, y + side * 0.3, random.uniform(-0.03, 0.03), random), x += 5;
            else add_car(scene, x, y, random.uniform(-0.05, 0.05), random);
        }
}

void add_heavy_traffic(Scene& scene, Lcg& random) {
    const double ahead = random.uniform(8, 14);  // middle of the vehicle in our lane: its rear is 6–12 m ahead
    const double aside = random.uniform(-0.4, 0.4), turned = random.uniform(-0.03, 0.03);
    if (random.chance(0.5)) add_lorry(scene, ahead + 3, aside, turned, random);
    else add_car(scene, ahead, aside, turned, random);
    for (const double lane : {-3.3, 3.3})
        for (double x = random.uniform(3, 9); x < 45; x += random.uniform(6, 9.5)) {
            const double y = lane + random.uniform(-0.3, 0.3), yaw = random.uniform(-0.06, 0.06);
            if (random.chance(0.4)) add_lorry(scene, x + 3, y, yaw, random), x += 4.5;
            else add_car(scene, x, y, yaw, random);
        }
    for (double x = ahead + 9; x < 50; x += random.uniform(7, 11)) add_car(scene, x, random.uniform(-0.3, 0.3), 0.0, random);
}

void add_car_ahead(Scene& scene, const StreetStyle& style, Lcg& random) {
    const double x = style.vehicle_ahead_nearest + random.uniform(2, 14), y = random.uniform(-0.5, 0.5);
    add_car(scene, x, y, 0.0, random);
}

Texture asphalt(const StreetStyle& style, Lcg& random) {
    const double grey = random.uniform(80, 110), contrast = style.road_contrast * random.uniform(0.85, 1.1);
    Texture texture = surface_texture(grey, contrast, random);
    if (style.markings) texture.pattern = Pattern::lane_markings;
    texture.marking_offset = random.uniform(1.6, 1.9);
    return texture;
}

}  // namespace

Texture surface_texture(double base_grey, double contrast, Lcg& random) {
    Texture texture;
    texture.seed = static_cast<std::uint32_t>(random.next());
    texture.base_grey = base_grey;
    texture.contrast = contrast;
    return texture;
}

void add_car(Scene& scene, double x, double y, double yaw, Lcg& random) {
    const double length = random.uniform(3.8, 4.7), width = random.uniform(1.65, 1.85), base = scene.road.elevation(x, y);
    const double bonnet_top = random.uniform(0.8, 1.0), roof = random.uniform(1.4, 1.7);
    const double paint_grey = random.uniform(50, 200), paint_contrast = random.uniform(0.4, 1.0);
    const Texture paint = surface_texture(paint_grey, paint_contrast, random);
    const Texture glass = surface_texture(random.uniform(40, 80), 0.7, random);
    add_turned_box(scene, {x, y, base + 0.5 * (0.2 + bonnet_top)},
                   {length / 2, width / 2, 0.5 * (bonnet_top - 0.2)}, yaw, paint);
    add_turned_box(scene, {x - 0.2, y, base + 0.5 * (bonnet_top + roof)},
                   {length * 0.28, width * 0.45, 0.5 * (roof - bonnet_top)}, yaw, glass);
}

void add_lorry(Scene& scene, double x, double y, double yaw, Lcg& random) {
    const double length = random.uniform(6, 9), top = random.uniform(2.8, 3.8), base = scene.road.elevation(x, y);
    Texture panel = surface_texture(random.uniform(80, 190), 0.8, random);
    panel.pattern = Pattern::vehicle_rear;
    add_turned_box(scene, {x, y, base + 0.5 * (0.6 + top)}, {length / 2, 1.2, 0.5 * (top - 0.6)}, yaw, panel);
    add_turned_box(scene, {x, y, base + 0.45}, {length / 2 - 0.2, 1.0, 0.15}, yaw, surface_texture(45, 0.8, random));
}

Bonnet own_bonnet(Lcg& random) {
    Bonnet bonnet;
    bonnet.drop = random.uniform(0.42, 0.52);
    bonnet.tilt = random.uniform(0.02, 0.08);
    bonnet.curvature = random.uniform(0.04, 0.10);
    bonnet.length = random.uniform(1.45, 1.65);
    bonnet.texture = surface_texture(random.uniform(60, 140), 0.8, random);
    bonnet.texture.finest_wavelength = 0.002;
    return bonnet;
}

Scene street(const StreetStyle& style, Lcg& random) {
    Scene scene;
    scene.road.texture = asphalt(style, random);
    scene.road.crown = style.crown;
    scene.sky_grey = random.uniform(190, 225);
    add_pavements(scene, style, random);
    add_facades(scene, style, random);
    add_trees_and_poles(scene, style, random);
    add_parked(scene, style, random);
    if (style.heavy_traffic) add_heavy_traffic(scene, random);
    else if (random.chance(style.vehicle_ahead_share)) add_car_ahead(scene, style, random);
    return scene;
}

}  // namespace fixtures
