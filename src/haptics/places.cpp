#include "places.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "common/messages/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] A barycentric coordinate up to this counts as zero: the point does not depend on the vertex.
constexpr double kOnEdge = 1e-9;
/// [m] Smaller differences between the distances of two faces count as rounding errors.
constexpr double kNearer = 1e-9;
/// The most places of a state.
constexpr std::size_t kMostPlaces = 32;
/// [m] Faces around a corner whose nearest points are nearer to each other than this are one place.
constexpr double kSamePlace = 1e-6;

/// Whether a face contains the nearest point of another face, by their indices of vertices.
bool contains_point(const FaceContact& face, const FaceContact& other) {
  const auto& vertices = face.vertices;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t vertex = other.vertices[static_cast<std::size_t>(k)];
    if (other.barycentric[k] > kOnEdge &&
        std::find(vertices.begin(), vertices.end(), vertex) == vertices.end()) {
      return false;
    }
  }
  return true;
}

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

std::vector<std::size_t> basins_of(const std::vector<ProxyFace>& contacts) {
  // The contacts of an organ and a link, by a vertex of their faces.
  std::multimap<std::tuple<std::size_t, std::int32_t, std::uint32_t>, std::size_t> at_vertex;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const FaceContact& contact = contacts[i].contact;
    for (const std::uint32_t vertex : contact.vertices) {
      at_vertex.insert({{contacts[i].organ, contact.link, vertex}, i});
    }
  }
  std::vector<std::size_t> next(contacts.size());
  std::iota(next.begin(), next.end(), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const FaceContact& contact = contacts[i].contact;
    Eigen::Index most = 0;
    contact.barycentric.maxCoeff(&most);
    const std::uint32_t vertex = contact.vertices[static_cast<std::size_t>(most)];
    const auto [begin, end] = at_vertex.equal_range({contacts[i].organ, contact.link, vertex});
    for (auto at = begin; at != end; ++at) {
      const FaceContact& other = contacts[at->second].contact;
      const bool is_nearer = other.depth > contacts[next[i]].contact.depth + kNearer;
      if (is_nearer && contains_point(other, contact)) next[i] = at->second;
    }
  }
  for (std::size_t& end : next) {
    while (next[end] != end) end = next[end];  // The distances fall, so that each path ends.
  }
  return next;
}

std::vector<ProxyContact> places_of(const ProxyReport& report) {
  const std::vector<ProxyFace>& contacts = report.answer->contacts;
  const std::vector<std::size_t> basins = basins_of(contacts);
  const auto forces = forces_on(report);
  std::vector<Vector3d> of_patch(contacts.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const FaceContact& contact = contacts[i].contact;
    const auto force = forces.find({contacts[i].organ, contact.face, contact.link});
    if (force != forces.end()) of_patch[basins[i]] += force->second;
  }
  std::vector<ProxyContact> all, different;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (basins[i] == i) all.push_back(place_at(report, contacts[i], of_patch[i]));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  for (const ProxyContact& place : all) add(place, different);
  // Where there are more places than a state has, those that bear a force stay.
  for (auto at = different.end(); different.size() > kMostPlaces && at != different.begin();) {
    --at;
    if (to_eigen(at->force).isZero(0.0)) at = different.erase(at);
  }
  return different;
}

}  // namespace organ_collision
