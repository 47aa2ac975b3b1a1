#include "penalty_wrench.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "organ_collision/ros/conversions.hpp"
#include "organ_collision/ros/rejection.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

struct Push {
  Vector3d point;
  Vector3d normal;
  double depth;
  std::uint32_t link;
  double own_depth;  ///< what is left of it when the deeper ones are left; u in the law
};

/// Deepest first. Ties are decided by the place: the order of the contacts does not matter.
bool is_deeper(const Push& a, const Push& b) {
  const auto key = [](const Push& push) {
    return std::make_tuple(-push.depth, push.point.x(), push.point.y(), push.point.z(),
                           push.normal.x(), push.normal.y(), push.normal.z());
  };
  return key(a) < key(b);
}

std::vector<Push> pushes_of(const std::vector<Contact>& contacts) {
  std::vector<Push> pushes;
  for (const Contact& contact : contacts) {
    if (contact.depth <= 0.0) continue;
    const Vector3d normal(contact.normal.x, contact.normal.y, contact.normal.z);
    pushes.push_back({to_eigen(contact.point), normal, contact.depth, contact.link, contact.depth});
  }
  std::sort(pushes.begin(), pushes.end(), is_deeper);
  return pushes;
}

void find_own_depths(std::vector<Push>& pushes) {
  for (auto push = pushes.begin(); push != pushes.end(); ++push) {
    for (auto deeper = pushes.begin(); deeper != push && push->own_depth > 0.0; ++deeper) {
      if (deeper->link != push->link) continue;
      const double in_front = deeper->normal.dot(deeper->point - push->point);
      push->own_depth = std::max(0.0, std::min(push->own_depth, in_front));
    }
  }
}

double agreement(const Push& a, const Push& b) { return std::max(0.0, a.normal.dot(b.normal)); }

/// The sum of all own depths along the normal along which it is greatest [m].
double greatest_along_a_normal(const std::vector<Push>& own) {
  double greatest = 0.0;
  for (const Push& along : own) {
    double sum = 0.0;
    for (const Push& push : own) sum += push.own_depth * agreement(push, along);
    greatest = std::max(greatest, sum);
  }
  return greatest;
}

/// Where a push acts: the mean place of all that push its way.
Vector3d place_of(const Push& push, const std::vector<Push>& all) {
  Vector3d sum = Vector3d::Zero();
  double weights = 0.0;
  for (const Push& other : all) {
    const double weight = other.depth * agreement(other, push);
    sum += weight * other.point;
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

geometry_msgs::WrenchStamped penalty_wrench(const ContactArray& contacts, double stiffness) {
  geometry_msgs::WrenchStamped result;
  result.header = contacts.header;
  std::vector<Push> pushes = pushes_of(contacts.contacts);
  if (pushes.empty()) return result;

  find_own_depths(pushes);
  std::vector<Push> own;
  std::copy_if(pushes.begin(), pushes.end(), std::back_inserter(own),
               [](const Push& push) { return push.own_depth > 0.0; });
  const double scale = stiffness * pushes.front().depth / greatest_along_a_normal(own);
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (const Push& push : own) {
    const Vector3d part = -scale * push.own_depth * push.normal;
    force += part;
    torque += place_of(push, pushes).cross(part);
  }
  if (!force.allFinite() || !torque.allFinite()) {
    throw Rejection(ContactArray::INVALID_REQUEST, "force not finite",
                    "the force is not finite; the deepest of " + std::to_string(pushes.size()) +
                        " contacts is " + std::to_string(pushes.front().depth) + " m deep");
  }
  result.wrench.force = to_vector(force);
  result.wrench.torque = to_vector(torque);
  return result;
}

}  // namespace organ_collision
