#include "proxy_scene.hpp"

#include <organ_collision/ContactArray.h>

#include "ros/motion/transform_lookup.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {

Rejection no_organ() {
  return {ContactArray::NO_MESH, "no organ", "there is no organ; send one on organ_mesh"};
}

ProxyScene proxy_scene(const OrganRegistry& organs, const TransformBuffer& transforms,
                       const std::string& frame, double mesh_timeout_sec, ros::Time now) {
  if (organs.organs().empty()) throw no_organ();
  ProxyScene scene{frame, {}, {}};
  for (const auto& [name, organ] : organs.organs()) {
    if (is_stale(organ.latest(), now, mesh_timeout_sec)) {
      throw Rejection(ContactArray::STALE_MESH, reason_of(ContactArray::STALE_MESH),
                      stale_message(name, organ.latest(), now, mesh_timeout_sec));
    }
    const auto T_organ_proxy = look_up(transforms, organ.frame(), frame, ros::Time(0));
    if (!T_organ_proxy.found) {
      throw Rejection(ContactArray::NO_TRANSFORM, reason_of(ContactArray::NO_TRANSFORM),
                      "organ '" + name + "': " + T_organ_proxy.why_not);
    }
    scene.organs.push_back(
        {name, organ.latest().mesh, organ.latest().topology(), T_organ_proxy.found->value});
    scene.sources.push_back(&organ);
  }
  return scene;
}

}  // namespace organ_collision
