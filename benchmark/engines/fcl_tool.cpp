#include "fcl_tool.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;
using Model = fcl::BVHModel<fcl::OBBRSS<double>>;

std::shared_ptr<Model> model(const std::vector<Vector3d>& vertices,
                             const std::vector<fcl::Triangle>& triangles) {
  auto model = std::make_shared<Model>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

std::shared_ptr<Model> model(const OrganSurface& organ) {
  std::vector<Vector3d> vertices;
  for (std::size_t i = 0; i < organ.vertices.size(); i += 3) {
    vertices.emplace_back(organ.vertices[i], organ.vertices[i + 1], organ.vertices[i + 2]);
  }
  std::vector<fcl::Triangle> triangles;
  for (std::size_t i = 0; i < organ.triangles.size(); i += 3) {
    triangles.emplace_back(organ.triangles[i], organ.triangles[i + 1], organ.triangles[i + 2]);
  }
  return model(vertices, triangles);
}

std::shared_ptr<fcl::CollisionGeometryd> geometry(const LinkPart& part) {
  if (!part.surface) {
    const OrientedBox& box = part.bounds;
    return std::make_shared<fcl::Cylinderd>(box.half_size.x(), 2.0 * box.half_size.z());
  }
  std::vector<fcl::Triangle> triangles;
  for (const FaceIndices& face : part.surface->faces()) {
    triangles.emplace_back(face[0], face[1], face[2]);
  }
  return model(part.surface->vertices(), triangles);
}

}  // namespace

struct FclTool::Placed {
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  Eigen::Isometry3d pose;
};

struct FclTool::Objects {
  struct Part {
    std::size_t link;
    std::shared_ptr<fcl::CollisionGeometryd> geometry;
    Eigen::Isometry3d T_link_part;
  };
  std::shared_ptr<Model> organ;
  std::vector<Part> parts;
};

FclTool::FclTool(const OrganSurface& organ, double radius, const std::vector<Link>& links)
    : radius_(radius), objects_(new Objects{model(organ), {}}) {
  for (std::size_t link = 0; link < links.size(); ++link) {
    for (const LinkPart& part : links[link].parts) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      if (!part.surface) {
        pose.linear() = part.bounds.axes;
        pose.translation() = part.bounds.center;
      }
      objects_->parts.push_back({link, geometry(part), pose});
    }
  }
}

FclTool::~FclTool() = default;

std::vector<FclTool::Placed> FclTool::place(const ToolWaypoint& tool) const {
  const Vector3d along = tool.axis.tip - tool.axis.trocar;
  Eigen::Isometry3d shaft = Eigen::Isometry3d::Identity();
  shaft.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along).toRotationMatrix();
  shaft.translation() = tool.axis.at(0.5);
  std::vector<Placed> placed{{std::make_shared<fcl::Capsuled>(radius_, along.norm()), shaft}};
  for (const Objects::Part& part : objects_->parts) {
    placed.push_back({part.geometry, tool.links[part.link] * part.T_link_part});
  }
  return placed;
}

void FclTool::query(const ToolWaypoint& tool, std::vector<std::uint32_t>& faces) const {
  faces.clear();
  fcl::CollisionRequestd request;
  request.num_max_contacts = 1'000'000;
  request.enable_contact = true;  // FCL gives the numbers of faces only with contacts.
  for (const auto& [geometry, pose] : place(tool)) {
    fcl::CollisionResultd result;
    fcl::collide(objects_->organ.get(), Eigen::Isometry3d::Identity(), geometry.get(), pose,
                 request, result);
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      faces.push_back(static_cast<std::uint32_t>(result.getContact(i).b1));
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

}  // namespace organ_collision::bench
