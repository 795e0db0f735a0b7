// Views without any road whose surfaces tempt an estimator to see one. The camera is at the world's origin height, X ahead.
#pragma once
#include "hashing.hpp"
#include "scene.hpp"

namespace fixtures {

Scene wall_ahead(Lcg& random);
Scene side_wall(Lcg& random);
Scene ceiling(Lcg& random);
Scene fence(Lcg& random);
Scene lorry_back(Lcg& random);
Scene bonnet_only(Lcg& random);

}  // namespace fixtures
