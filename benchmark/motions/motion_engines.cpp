#include "motion_engines.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

namespace organ_collision::bench {
namespace {

struct Answers {
  explicit Answers(PickerKind picker) : query(picker) {}

  CollisionQuery query;
  CollisionResult result;
};

}  // namespace

MotionEngines::MotionEngines(const OrganSurface& organ, const MotionSet& motions)
    : motions_(motions),
      organ_(organ.vertices, organ.triangles),
      fcl_(organ, motions.radius, motions.links) {}

MotionEngines::Ask MotionEngines::asker(const std::string& engine) const {
  if (engine == "fcl_touches") {
    return [this](const ToolPath& path) -> std::size_t { return fcl_.touches(path.back()); };
  }
  if (engine == "fcl") {
    return [this, faces = std::vector<std::uint32_t>()](const ToolPath& path) mutable {
      fcl_.query(path.back(), faces);
      return faces.size();
    };
  }
  if (engine == "static") return own_asker(QueryMode::kStatic, PickerKind::kFeedback);
  if (engine == "static_cpu") return own_asker(QueryMode::kStatic, PickerKind::kCpu);
  if (engine == "swept") return own_asker(QueryMode::kSwept, PickerKind::kFeedback);
  throw std::invalid_argument("the engine is '" + engine +
                              "'; legal are static, static_cpu, swept, fcl and fcl_touches");
}

MotionEngines::Ask MotionEngines::own_asker(QueryMode mode, PickerKind picker) const {
  return [this, mode, answers = std::make_shared<Answers>(picker)](const ToolPath& path) {
    answers->query.evaluate(request(path, mode), answers->result);
    return answers->result.contacts.size();
  };
}

MotionEngines::Comparison MotionEngines::compare(std::size_t count) const {
  CollisionQuery query;
  CollisionResult result;
  std::vector<std::uint32_t> fcl;
  Comparison comparison;
  for (std::size_t i = 0; i < std::min(count, motions_.paths.size()); ++i) {
    query.evaluate(request(motions_.paths[i], QueryMode::kStatic), result);
    std::vector<std::uint32_t> ours;
    for (const FaceContact& contact : result.contacts) ours.push_back(contact.face);
    ours.erase(std::unique(ours.begin(), ours.end()), ours.end());
    fcl_.query(motions_.paths[i].back(), fcl);
    std::vector<std::uint32_t> both;
    std::set_intersection(ours.begin(), ours.end(), fcl.begin(), fcl.end(),
                          std::back_inserter(both));
    comparison.faces += ours.size();
    comparison.missed_by_fcl += ours.size() - both.size();
    comparison.only_by_fcl += fcl.size() - both.size();
  }
  return comparison;
}

CollisionRequest MotionEngines::request(const ToolPath& path, QueryMode mode) const {
  CollisionRequest request;
  request.organ = &organ_;
  request.path = path;
  request.radius = motions_.radius;
  request.links = motions_.links.empty() ? nullptr : &motions_.links;
  request.mode = mode;
  return request;
}

}  // namespace organ_collision::bench
