#include "places.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "common/messages/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// The most places of a state.
constexpr std::size_t kMostPlaces = 32;
/// [m] Faces around a corner whose nearest points are nearer to each other than this are one place.
constexpr double kSamePlace = 1e-6;

/// [N] The published force of the proxy on faces, by organ, face and link, in the proxy's frame.
std::map<std::tuple<std::size_t, std::uint32_t, std::int32_t>, Vector3d> forces_on(
    const ProxyReport& report) {
  std::map<std::tuple<std::size_t, std::uint32_t, std::int32_t>, Vector3d> forces;
  for (std::size_t i = 0; i < report.scene->organs.size(); ++i) {
    const ProxyOrgan& organ = report.scene->organs[i];
    for (const OrganForce& of_organ : report.forces) {
      if (of_organ.organ != report.scene->sources[i]->name()) continue;
      if (of_organ.topology != organ.shape->topology()) continue;
      for (const FaceForce& at : of_organ.on_faces) {
        const Vector3d force = -(organ.T_organ_proxy.linear().transpose() * at.force);
        forces.insert({{i, at.face, at.link}, Vector3d::Zero()}).first->second += force;
      }
    }
  }
  return forces;
}

ProxyContact place_at(const ProxyReport& report, const ProxyFace& at, const Vector3d& force) {
  ProxyContact place;
  place.organ = report.scene->sources[at.organ]->name();
  place.link = at.contact.link;
  place.face = at.contact.face;
  for (std::size_t k = 0; k < 3; ++k) {
    place.vertices[k] = at.contact.vertices[k];
    place.barycentric[k] = at.contact.barycentric[static_cast<int>(k)];
  }
  place.point = tf2::toMsg(at.contact.point);
  place.normal = to_vector(at.contact.normal);
  place.distance = -at.contact.depth;
  place.clearance = at.clearance;
  place.velocity = to_vector(tissue_velocity(*report.scene, at.organ, at.contact));
  place.force = to_vector(force);
  return place;
}

/// Adds a place, or its force to a place that is the same.
void add(const ProxyContact& place, std::vector<ProxyContact>& places) {
  const auto same = std::find_if(places.begin(), places.end(), [&](const auto& other) {
    return other.organ == place.organ && other.link == place.link &&
           (to_eigen(other.point) - to_eigen(place.point)).norm() < kSamePlace;
  });
  if (same == places.end()) {
    places.push_back(place);
  } else {
    same->force = to_vector(to_eigen(same->force) + to_eigen(place.force));
  }
}

}  // namespace

std::vector<ProxyContact> places_of(const ProxyReport& report,
                                    const std::vector<ProxyFace>& contacts) {
  const auto forces = forces_on(report);
  std::vector<ProxyContact> all, different;
  for (const ProxyFace& contact : contacts) {
    const auto force = forces.find({contact.organ, contact.contact.face, contact.contact.link});
    const bool bears = contact.load > 0.0 && force != forces.end();
    all.push_back(place_at(report, contact, bears ? force->second : Vector3d::Zero()));
  }
  const auto spare = [](const ProxyContact& place) { return place.distance - place.clearance; };
  std::stable_sort(all.begin(), all.end(),
                   [&](const auto& a, const auto& b) { return spare(a) < spare(b); });
  for (const ProxyContact& place : all) add(place, different);
  // Where there are more places than a state has, those stay that bear a force or leave the tool
  // the least way. For each link, one stays: a controller would otherwise not know that it is near.
  for (auto at = different.end(); different.size() > kMostPlaces && at != different.begin();) {
    --at;
    const bool is_nearest = std::none_of(
        different.begin(), at, [&](const auto& nearer) { return nearer.link == at->link; });
    if (!is_nearest && to_eigen(at->force).isZero(0.0)) at = different.erase(at);
  }
  std::stable_sort(different.begin(), different.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  return different;
}

}  // namespace organ_collision
