#pragma once

#include <organ_collision/OrganInfo.h>
#include <ros/time.h>

#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// What is known of an organ's surface as long as its triangles stay the same. For a large mesh, it
/// takes tens of milliseconds to find out, so that a background thread does it (organ_intake.hpp).
class OrganSurface {
 public:
  /// `mesh`: as its message describes it. The vertices of this shape are welded. Takes no time.
  explicit OrganSurface(const TriangleMesh& mesh)
      : faces_(mesh.shared_faces()),
        vertices_(mesh.shared_vertices()),
        box_(mesh.box().cast<double>()) {}

  /// Finds out everything. Does nothing if that is done. Only one thread may call this.
  void find();

  // For any thread.

  /// Whether find() is done.
  bool is_found() const { return wait_until_found(std::chrono::milliseconds(0)); }
  /// Waits until find() is done in another thread, but at most for `longest`. Returns is_found().
  bool wait_until_found(std::chrono::milliseconds longest) const {
    return found_.wait_for(longest) == std::future_status::ready;
  }
  std::size_t face_count() const { return faces_->size(); }
  /// [m] Around the mesh as its message described it.
  const Eigen::AlignedBox3d& box() const { return box_; }

  // For any thread, once is_found().

  const SurfaceTopology& topology() const { return found_.get().topology; }
  /// Whether the surface is closed and its faces point inward.
  bool is_inward() const { return found_.get().is_inward; }
  /// [m^3] Signed, see signed_volume(). `vertices`: the present positions [m].
  double volume(const std::vector<float>& vertices) const {
    return signed_volume(topology(), *faces_, vertices);
  }

 private:
  struct Found {
    SurfaceTopology topology;
    bool is_inward;
  };

  SharedFaces faces_;
  SharedVertices vertices_;  ///< of the message; released when everything is found
  Eigen::AlignedBox3d box_;
  std::promise<Found> promise_;
  std::shared_future<Found> found_ = promise_.get_future().share();
};

/// An organ's surface at one time. Its users share it, and it does not change while they use it.
struct OrganShape {
  std::shared_ptr<const TriangleMesh> mesh;  ///< null: no shape
  ros::Time stamp;                           ///< as sent; zero: unstamped
  ros::Time received;
  std::shared_ptr<OrganSurface> surface = {};  ///< of the mesh's triangles; null: no shape

  /// How the mesh's faces join. Null as long as that is not found.
  const SurfaceTopology* topology() const {
    return surface->is_found() ? &surface->topology() : nullptr;
  }

  /// [s] The time since the stamp, or since the message came if it has no stamp, or one that was in
  /// the future then. (Before the first /clock, messages come at time zero, and every stamp
  /// counts.)
  double age(ros::Time now) const {
    const bool is_of_future = received < stamp && !received.isZero();
    return now.toSec() - (stamp.isZero() || is_of_future ? received : stamp).toSec();
  }
};

/// A named organ: its frame, its latest shape and the one before.
class DeformableOrgan {
 public:
  DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh, ros::Time stamp,
                  ros::Time received);

  const std::string& name() const { return name_; }
  const std::string& frame() const { return frame_; }
  const OrganShape& latest() const { return latest_; }
  /// The shape before the latest one. It has no mesh if the latest one is the first of its
  /// topology, or after forget_previous().
  const OrganShape& previous() const { return previous_; }
  /// What is known of the surface. Another object if the triangles change.
  const std::shared_ptr<OrganSurface>& surface() const { return latest_.surface; }

  /// Sets new positions for the same triangles. Throws MeshError, and changes nothing, if they do
  /// not fit. Takes over the memory of a shape that nobody uses any more, if there is one.
  void move(SharedVertices vertices, ros::Time stamp, ros::Time received);
  /// Sets a new mesh with other triangles.
  void replace(TriangleMesh mesh, ros::Time stamp, ros::Time received);

  /// The previous shape, which was in another frame, is forgotten.
  void set_frame(std::string frame) {
    frame_ = std::move(frame);
    previous_ = {};
  }
  void forget_previous() { previous_ = {}; }
  /// For a clock that jumped back to `now`, or began: the latest shape counts as received then at
  /// the latest.
  void receive_anew(ros::Time now);

 private:
  std::shared_ptr<TriangleMesh> unused_shape();

  std::string name_;
  std::string frame_;
  OrganShape latest_;
  OrganShape previous_;
  std::vector<std::shared_ptr<TriangleMesh>> shapes_;  ///< of the present topology
};

// What users are told about an organ.

/// "closed", "open (12 edges)", or "not yet known". An edge is open if it has no opposite.
std::string closedness(const OrganSurface& surface);
/// "outward" or "inward" for a closed surface, otherwise "none". "not yet known" if it is not
/// found.
std::string orientation(const OrganSurface& surface);
/// For example "organ 'kidney': 2208 faces, closed, 0.12 x 0.09 x 0.06 m".
std::string summary(const std::string& organ, const OrganSurface& surface);
/// Whole sentences about what is legal, but probably a mistake: the organ's size, and faces that
/// point inward. `box`: around the organ [m].
std::vector<std::string> doubts(const std::string& organ, const Eigen::AlignedBox3d& box,
                                const OrganSurface& surface);
/// Everything about the organ's latest shape. Takes milliseconds for a large mesh, because it finds
/// out what is not yet known.
OrganInfo info_of(const DeformableOrgan& organ);

/// Tells the user in the log which surfaces came.
class SurfaceLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// An organ whose triangles change all the time, as in cutting, is told about at most once in
  /// this time. The same holds for what is doubtful about it.
  static constexpr std::chrono::seconds kPeriod{5};

  /// Logs the summary of a surface that is found, and the doubts about it.
  void tell(const std::string& organ, const OrganSurface& surface, Time now);

 private:
  struct Next {
    Time summary{}, doubts{};  ///< not before these
  };
  std::map<std::string, Next> next_;  ///< by organ
};

}  // namespace organ_collision
