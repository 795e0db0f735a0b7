#include "recording_sets.hpp"

#include <cmath>
#include <iterator>
#include <utility>

#include "degradation.hpp"
#include "hashing.hpp"
#include "no_road_scenes.hpp"
#include "street.hpp"

namespace fixtures {
namespace {

double uniform_angle(Lcg& random, double low_deg, double high_deg) { return radians(random.uniform(low_deg, high_deg)); }

Pose random_pose(Lcg& random, double largest_roll_deg) {
    Pose pose;
    pose.pitch = uniform_angle(random, -1.0, 4.0);
    pose.roll = uniform_angle(random, -largest_roll_deg, largest_roll_deg);
    pose.yaw = uniform_angle(random, -2.0, 2.0);
    pose.position = {0.0, random.uniform(-0.3, 0.3), random.uniform(1.2, 1.8)};
    return pose;
}

FrameRecipe recipe_of(Scene scene, const Pose& pose, const char* name, const FrameIndex& index) {
    FrameRecipe recipe{std::move(scene), pose, name, {}, {}};
    recipe.noise.seed = mix(index.frame_seed(), 77);
    return recipe;
}

FrameRecipe roll_sweep(const FrameIndex& index) {
    Lcg random(index.frame_seed());
    Pose pose = random_pose(random, 0.0);
    pose.roll = radians(-20.0 + 40.0 * index.fraction());
    pose.pitch = uniform_angle(random, -3.0, 6.0);
    return recipe_of(street({}, random), pose, "street", index);
}

// The camera drives up to 25 m through a standing scene, so the vehicle ahead stands well beyond that.
StreetStyle style_of_drive() {
    StreetStyle style;
    style.vehicle_ahead_nearest = 40.0;
    return style;
}

// One drive along one street: the scene comes from the recording's seed, the pose from the frame's.
FrameRecipe level(const FrameIndex& index) {
    Lcg layout(index.recording_seed), random(index.frame_seed());
    Pose pose;
    pose.pitch = radians(1.0) + uniform_angle(random, -0.6, 0.6);
    pose.position = {1.1 * index.frame, 0.1, 1.4 + random.uniform(-0.01, 0.01)};
    return recipe_of(street(style_of_drive(), layout), pose, "street", index);
}

struct SpeedBump {
    double start = 20.0, length = 3.7, height = 0.08;
};

// The body is a rigid bar on two axles, the camera rides 0.8 m behind the front one.
Pose pose_over_bump(const RoadSurface& road, double front_axle) {
    constexpr double wheelbase = 2.7, behind_front = 0.8, mount_height = 1.4;
    const double front = road.elevation(front_axle, 0.0), rear = road.elevation(front_axle - wheelbase, 0.0);
    const double nose_up = std::atan2(front - rear, wheelbase);
    Pose pose;
    pose.pitch = radians(1.0) - nose_up;
    pose.position = {front_axle - behind_front * std::cos(nose_up) - mount_height * std::sin(nose_up), 0.1,
                     front - behind_front * std::sin(nose_up) + mount_height * std::cos(nose_up)};
    return pose;
}

FrameRecipe speed_bump(const FrameIndex& index) {
    Lcg layout(index.recording_seed);
    const SpeedBump bump;
    Scene scene = street(style_of_drive(), layout);
    scene.road.bump_start = bump.start;
    scene.road.bump_length = bump.length;
    scene.road.bump_height = bump.height;
    // Four frames show the four acts: ahead, front wheels up, rear wheels up, behind.
    const double acts[] = {-5.0, 1.6, 4.4, 8.0};
    const double past_start = index.count == 4 ? acts[index.frame] : -8.0 + 17.0 * index.fraction();
    return recipe_of(scene, pose_over_bump(scene.road, bump.start + past_start), "bump", index);
}

StreetStyle traffic_style() {
    StreetStyle style;
    style.heavy_traffic = true;
    style.kerb = 5.6;
    style.parked_offset = 5.1;
    return style;
}

FrameRecipe traffic(const FrameIndex& index) {
    Lcg random(index.frame_seed());
    const Pose pose = random_pose(random, 4.0);
    return recipe_of(street(traffic_style(), random), pose, "traffic", index);
}

FrameRecipe weak_texture(const FrameIndex& index) {
    Lcg random(index.frame_seed());
    const Pose pose = random_pose(random, 4.0);
    StreetStyle style;
    style.road_contrast = random.uniform(0.13, 0.24);
    style.markings = random.chance(0.5);
    FrameRecipe recipe = recipe_of(street(style, random), pose, "weak-texture", index);
    recipe.noise.standard_deviation = 1.5;
    return recipe;
}

FrameRecipe block_matcher(const FrameIndex& index) {
    Lcg random(index.frame_seed());
    const Pose pose = random_pose(random, 4.0);
    StreetStyle style;
    style.road_contrast = random.uniform(0.25, 0.45);
    return recipe_of(street(style, random), pose, "street", index);
}

// The right lane of a road that falls 0.8–1.4° to the gutter; the car keeps almost level.
FrameRecipe crown(const FrameIndex& index) {
    Lcg random(index.frame_seed());
    Pose pose = random_pose(random, 0.1);
    const double lane_middle = -1.9 + random.uniform(-0.1, 0.1);
    StreetStyle style;
    style.kerb = 5.0;
    style.parked_offset = 5.3;
    style.vehicle_ahead_share = 0.3;
    style.crown = std::tan(uniform_angle(random, 0.9, 1.4)) / (2.0 * std::abs(lane_middle));
    Scene scene = street(style, random);
    pose.yaw = 0.0;
    pose.position[1] = lane_middle;
    pose.position[2] += scene.road.elevation(0.0, lane_middle);
    return recipe_of(scene, pose, "crown", index);
}

FrameRecipe dirt(const FrameIndex& index) {
    static const char* const names[] = {"lost-rows", "bonnet-and-salt", "lost-regions", "all-together"};
    const int kind = index.frame % 4;
    Lcg random(index.frame_seed());
    const Pose pose = random_pose(random, 4.0);
    Scene scene = street({}, random);
    if (kind == 1 || kind == 3) scene.bonnet = own_bonnet(random);
    FrameRecipe recipe = recipe_of(scene, pose, names[kind], index);
    recipe.damage = [kind, seed = random.next()](cv::Mat& disparity) {
        Lcg damage(seed);
        if (kind == 0 || kind == 3) lose_row_bands(disparity, damage.integer(4, 8), 24, damage);
        if (kind == 2 || kind == 3) lose_regions(disparity, damage.integer(4, 9), damage);
        if (kind == 2) lose_at_random(disparity, damage.uniform(0.2, 0.6), damage);
        if (kind == 1 || kind == 3) add_salt(disparity, damage.uniform(0.01, 0.05), 127.0, damage);
    };
    return recipe;
}

struct NoRoadKind {
    const char* name;
    Scene (*scene)(Lcg&);  // null: nothing is rendered that matters
    void (*damage)(cv::Mat&, Lcg&);
};

const NoRoadKind no_road_kinds[] = {
    {"empty", nullptr, [](cv::Mat& d, Lcg&) { lose_everything(d); }},
    {"wall-ahead", wall_ahead, nullptr},
    {"side-wall", side_wall, nullptr},
    {"ceiling", ceiling, nullptr},
    {"noise", nullptr, [](cv::Mat& d, Lcg& r) { replace_by_noise(d, r.uniform(20, 127), r); }},
    {"fence", fence, nullptr},
    {"lorry-back", lorry_back, nullptr},
    {"bonnet-only", bonnet_only, nullptr},
    {"fog", nullptr, [](cv::Mat& d, Lcg& r) { replace_by_fog(d, r.uniform(8, 90), r); }},
};

FrameRecipe no_road(const FrameIndex& index) {
    const NoRoadKind& kind = no_road_kinds[index.frame % std::size(no_road_kinds)];
    Lcg random(index.frame_seed());
    Pose pose = random_pose(random, 5.0);
    pose.position = {0.0, 0.0, 1.5};
    Scene empty;
    empty.road.present = false;
    FrameRecipe recipe = recipe_of(kind.scene ? kind.scene(random) : empty, pose, kind.name, index);
    if (kind.damage)
        recipe.damage = [damage = kind.damage, seed = random.next()](cv::Mat& disparity) {
            Lcg noise(seed);
            damage(disparity, noise);
        };
    return recipe;
}

FrameRecipe wide_rig(const FrameIndex& index) {
    Lcg random(index.frame_seed());
    const Pose pose = random_pose(random, 8.0);
    return recipe_of(street(random.chance(0.4) ? traffic_style() : StreetStyle{}, random), pose, "street", index);
}

}  // namespace

std::uint64_t FrameIndex::frame_seed() const { return mix(recording_seed, static_cast<std::uint64_t>(frame) + 1); }

const std::vector<RecordingSet>& recording_sets() {
    static const Rig standard;
    static const Rig wide{1024, 512, 700.0, 511.5, 255.5, 0.50, 128};
    static const std::vector<RecordingSet> sets = {
        {"roll-sweep", 9, 41, standard, Matcher::semi_global, roll_sweep},
        {"level", 2, 20, standard, Matcher::semi_global, level},
        {"traffic", 4, 30, standard, Matcher::semi_global, traffic},
        {"no-road", 9, 36, standard, Matcher::semi_global, no_road},
        {"speed-bump", 4, 20, standard, Matcher::semi_global, speed_bump},
        {"weak-texture", 2, 20, standard, Matcher::semi_global, weak_texture},
        {"block-matcher", 2, 20, standard, Matcher::block, block_matcher},
        {"crown", 2, 20, standard, Matcher::semi_global, crown},
        {"dirt", 4, 20, standard, Matcher::semi_global, dirt},
        {"wide-rig", 0, 20, wide, Matcher::semi_global, wide_rig},
    };
    return sets;
}

}  // namespace fixtures
