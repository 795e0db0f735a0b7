#include "scene.hpp"

#include <algorithm>
#include <cmath>

namespace fixtures {
namespace {

constexpr double nearest_depth = 0.2;
constexpr double farthest_depth = 400.0;

// Smaller root of a·t² + b·t + c = 0 that is at least `from`; negative when there is none.
double quadratic_root(double a, double b, double c, double from) {
    if (std::abs(a) < 1e-12) {
        const double t = std::abs(b) > 1e-12 ? -c / b : -1.0;
        return t >= from ? t : -1.0;
    }
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return -1.0;
    // The stable pair of roots; the naive formula loses the digits the truth needs when a is tiny.
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    const double r1 = q / a, r2 = std::abs(q) > 1e-300 ? c / q : -1.0;
    const double low = std::min(r1, r2), high = std::max(r1, r2);
    return low >= from ? low : (high >= from ? high : -1.0);
}

// Depth where the ray enters the bump, or negative. The profile is smooth: march, then bisect.
double bump_depth(const RoadSurface& road, const Ray& ray) {
    const double dx = ray.direction[0];
    if (road.bump_length <= 0.0 || std::abs(dx) < 1e-9) return -1.0;
    const double to_start = (road.bump_start - ray.origin[0]) / dx;
    const double to_end = (road.bump_start + road.bump_length - ray.origin[0]) / dx;
    double before = std::max(std::min(to_start, to_end), nearest_depth);
    const double end = std::max(to_start, to_end);
    const auto clearance = [&](double t) {
        const cv::Vec3d p = ray.origin + t * ray.direction;
        return p[2] - road.elevation(p[0], p[1]);
    };
    constexpr int steps = 64;
    const double step = (end - before) / steps;
    for (int i = 0; i < steps && step > 0; ++i, before += step) {
        if (clearance(before) < 0 || clearance(before + step) >= 0) continue;
        double low = before, high = before + step;
        for (int k = 0; k < 40; ++k) (clearance(0.5 * (low + high)) >= 0 ? low : high) = 0.5 * (low + high);
        return high;
    }
    return -1.0;
}

void set_road_hit(const Scene& scene, const Ray& ray, double depth, Surface surface, Hit& hit) {
    const cv::Vec3d p = ray.origin + depth * ray.direction;
    hit = {surface, depth, &scene.road.texture, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {p[0], p[1]}};
}

void hit_road(const Scene& scene, const Ray& ray, Hit& hit) {
    const RoadSurface& road = scene.road;
    if (!road.present) return;
    const cv::Vec3d &o = ray.origin, &d = ray.direction;
    const double depth = quadratic_root(road.crown * d[1] * d[1], d[2] + 2 * road.crown * o[1] * d[1],
                                        o[2] + road.crown * o[1] * o[1], nearest_depth);
    const double on_bump = bump_depth(road, ray);
    if (on_bump > 0 && on_bump < hit.depth) return set_road_hit(scene, ray, on_bump, Surface::bump, hit);
    if (depth > 0 && depth < std::min(hit.depth, farthest_depth)) set_road_hit(scene, ray, depth, Surface::road, hit);
}

cv::Vec3d turned(const cv::Vec3d& v, double c, double s) { return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]}; }

void hit_box(const Solid& box, const Ray& ray, Hit& hit) {
    const double c = box.heading[0], s = box.heading[1];
    const cv::Vec3d o = turned(ray.origin - box.centre, c, -s), d = turned(ray.direction, c, -s);
    double enter = nearest_depth, leave = hit.depth;
    int face = -1;
    for (int k = 0; k < 3; ++k) {
        if (std::abs(d[k]) < 1e-12) {
            if (std::abs(o[k]) > box.half_size[k]) return;
            continue;
        }
        const double t1 = (-box.half_size[k] - o[k]) / d[k], t2 = (box.half_size[k] - o[k]) / d[k];
        if (std::min(t1, t2) > enter) enter = std::min(t1, t2), face = k;
        leave = std::min(leave, std::max(t1, t2));
    }
    if (face < 0 || enter >= leave) return;
    const int axis_s = face == 0 ? 1 : 0, axis_t = face == 2 ? 1 : 2;
    const cv::Vec3d p = o + enter * d;
    cv::Vec3d unit_s(0, 0, 0), unit_t(0, 0, 0), normal(0, 0, 0);
    unit_s[axis_s] = unit_t[axis_t] = normal[face] = 1.0;
    hit = {Surface::obstacle, enter, &box.texture, turned(normal, c, s), turned(unit_s, c, s), turned(unit_t, c, s),
           {p[axis_s] + 17.0 * face, p[axis_t]}};
}

// Cylinder and sphere share the texture that is wound around the vertical axis.
void set_round_hit(const Solid& solid, const Ray& ray, double depth, const cv::Vec3d& normal, Hit& hit) {
    const cv::Vec3d p = ray.origin + depth * ray.direction - solid.centre;
    const cv::Vec3d around = cv::normalize(cv::Vec3d(-p[1], p[0], 1e-12));
    hit = {Surface::obstacle, depth, &solid.texture, normal, around, {0, 0, 1},
           {solid.half_size[0] * std::atan2(p[1], p[0]), p[2]}};
}

void hit_cylinder(const Solid& cylinder, const Ray& ray, Hit& hit) {
    const cv::Vec3d o = ray.origin - cylinder.centre, &d = ray.direction;
    const double radius = cylinder.half_size[0];
    const double depth = quadratic_root(d[0] * d[0] + d[1] * d[1], 2 * (o[0] * d[0] + o[1] * d[1]),
                                        o[0] * o[0] + o[1] * o[1] - radius * radius, nearest_depth);
    if (depth < 0 || depth >= hit.depth || std::abs(o[2] + depth * d[2]) > cylinder.half_size[2]) return;
    const cv::Vec3d p = o + depth * d;
    set_round_hit(cylinder, ray, depth, cv::Vec3d(p[0], p[1], 0) / radius, hit);
}

void hit_sphere(const Solid& sphere, const Ray& ray, Hit& hit) {
    const cv::Vec3d o = ray.origin - sphere.centre, &d = ray.direction;
    const double radius = sphere.half_size[0];
    const double depth = quadratic_root(d.dot(d), 2 * o.dot(d), o.dot(o) - radius * radius, nearest_depth);
    if (depth < 0 || depth >= hit.depth) return;
    set_round_hit(sphere, ray, depth, (o + depth * d) / radius, hit);
}

// Most rays pass most solids by: compare with the sphere around the solid before anything dearer.
bool passes_by(const Solid& solid, const Ray& ray, double direction_squared) {
    const cv::Vec3d to_centre = solid.centre - ray.origin;
    const double along = to_centre.dot(ray.direction);
    const double distance_squared = to_centre.dot(to_centre) - along * along / direction_squared;
    return distance_squared > solid.half_size.dot(solid.half_size);
}

void hit_bonnet(const Bonnet& bonnet, const Ray& ray, Hit& hit) {
    const cv::Vec3d &o = ray.camera_origin, &d = ray.camera_direction;
    const double k = bonnet.curvature;
    const double depth = quadratic_root(k * d[0] * d[0], 2 * k * o[0] * d[0] + bonnet.tilt * d[2] - d[1],
                                        k * o[0] * o[0] + bonnet.drop - o[1], nearest_depth);
    if (depth < 0 || depth >= hit.depth || depth > bonnet.length) return;
    const cv::Vec3d p = o + depth * d;
    if (std::abs(p[0]) > bonnet.half_width) return;
    hit = {Surface::bonnet, depth, &bonnet.texture, {0, -1, bonnet.tilt}, {1, 0, 0}, {0, 0, 1}, {p[0], p[2]}};
}

}  // namespace

double RoadSurface::elevation(double x, double y) const {
    const double base = -crown * y * y, along = x - bump_start;
    if (bump_length <= 0.0 || along <= 0.0 || along >= bump_length) return base;
    return base + 0.5 * bump_height * (1.0 - std::cos(2.0 * pi * along / bump_length));
}

Hit first_hit(const Scene& scene, const Ray& ray) {
    Hit hit;
    hit_road(scene, ray, hit);
    const double direction_squared = ray.direction.dot(ray.direction);
    for (const Solid& solid : scene.solids) {
        if (passes_by(solid, ray, direction_squared)) continue;
        if (solid.shape == Shape::box) hit_box(solid, ray, hit);
        if (solid.shape == Shape::cylinder) hit_cylinder(solid, ray, hit);
        if (solid.shape == Shape::sphere) hit_sphere(solid, ray, hit);
    }
    if (scene.bonnet) hit_bonnet(*scene.bonnet, ray, hit);
    return hit;
}

}  // namespace fixtures
