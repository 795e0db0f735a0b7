// Streets: road, pavements, facades, trees, poles and vehicles, laid out by a seed.
#pragma once
#include "hashing.hpp"
#include "scene.hpp"

namespace fixtures {

struct StreetStyle {
    double kerb = 3.5;               // pavements (15 cm high) begin at ± this many metres
    double road_contrast = 1.0;
    double crown = 0.0;
    double parked_share = 0.5;       // of the places at the kerb that are taken
    double parked_offset = 2.75;     // y of the parked vehicles' middle
    double vehicle_ahead_nearest = 12.0;
    double vehicle_ahead_share = 0.5;
    bool heavy_traffic = false;      // lanes at y = 0 and ±3.3 m full of cars and lorries, 6–25 m ahead
    bool markings = true;
};

Scene street(const StreetStyle& style, Lcg& random);

void add_car(Scene& scene, double x, double y, double yaw, Lcg& random);
void add_lorry(Scene& scene, double x, double y, double yaw, Lcg& random);
Bonnet own_bonnet(Lcg& random);

Texture surface_texture(double base_grey, double contrast, Lcg& random);

}  // namespace fixtures
