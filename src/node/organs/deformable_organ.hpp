#pragma once

#include <organ_collision/OrganInfo.h>
#include <ros/time.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/messages/conversions.hpp"
#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"

namespace organ_collision {

/// What is known of an organ's surface as long as its triangles stay the same. For a large mesh, it
/// takes tens of milliseconds to find out, so that a background thread does it (organ_intake.hpp).
class OrganSurface {
 public:
  /// `mesh`: the shape that came with the triangles. Vertices that are at the same place in this
  /// shape count as one (SurfaceTopology). find() does the work.
  explicit OrganSurface(const TriangleMesh& mesh)
      : faces_(mesh.shared_faces()),
        vertices_(mesh.shared_vertices()),
        box_(mesh.box().cast<double>()) {}

  /// Finds out how the faces join, and their orientation, once. Only one thread may call find().
  void find();

  // Any thread may call these functions at any time.

  /// Whether find() is done.
  bool is_found() const { return wait_until_found(std::chrono::milliseconds(0)); }
  /// Waits until find() is done in another thread, but at most for `longest`. Returns is_found().
  bool wait_until_found(std::chrono::milliseconds longest) const {
    return found_.wait_for(longest) == std::future_status::ready;
  }
  std::size_t face_count() const { return faces_->size(); }
  /// [m] The box around the mesh that the constructor was given.
  const Eigen::AlignedBox3d& box() const { return box_; }

  // Any thread may call these functions once is_found() is true.

  const SurfaceTopology& topology() const { return found_.get().topology; }
  /// Whether the surface is closed and its faces point inward.
  bool is_inward() const { return found_.get().is_inward; }

 private:
  struct Found {
    SurfaceTopology topology;
    bool is_inward;
  };

  SharedFaces faces_;
  SharedVertices vertices_;  ///< those of the constructor's mesh; null when found
  Eigen::AlignedBox3d box_;
  std::promise<Found> promise_;
  std::shared_future<Found> found_ = promise_.get_future().share();
};

/// What is remembered of an organ or a tool counts only as long as both numbers of it stay: that of
/// its history, and the topology of an organ's triangles. With new triangles, the next step is
/// static for the organ. With another history, everything begins anew.
struct History {
  std::uint64_t number = 0;  ///< of the present history; each history has another one
  std::string why = {};      ///< why it began, as TouchEvent.reason; empty: the name is new
};

/// An organ's surface at one time. Its users share it, and it does not change while they use it.
struct OrganShape {
  std::shared_ptr<const TriangleMesh> mesh;  ///< null: no shape
  ros::Time stamp;                           ///< the stamp of the message; zero: it has none
  ros::Time received;                        ///< when the message was applied, by the node's clock
  std::shared_ptr<OrganSurface> surface = {};  ///< what is known of the triangles; null: no shape
  std::uint64_t history = 0;                   ///< the number of the history in which it came
  /// The shape before, with the same triangles. Null if this one is the first with its triangles or
  /// of its history.
  std::shared_ptr<const TriangleMesh> before = {};
  /// [s] from `before` to this shape, by their stamps. If one of them has no stamp: by their
  /// arrival
  double motion_sec = 0.0;
  double period_sec = 0.0;  ///< [s] the same or the time between their arrivals, what is longer

  /// The shape from which the tissue has come with a constant velocity, which it has at `now`, too,
  /// within motion_sec. This is the velocity of tissue in all answers. Null if the tissue rests: it
  /// has no shape before, the stamps do not rise, or the next shape is overdue (goes_on()).
  std::shared_ptr<const TriangleMesh> moves_from(ros::Time now) const {
    const bool moves = motion_sec > 0.0 && goes_on(period_sec, received, now);
    return moves ? before : nullptr;
  }

  /// How the mesh's faces join. Null until OrganSurface::find() is done.
  const SurfaceTopology* topology() const {
    return surface->is_found() ? &surface->topology() : nullptr;
  }

  /// [s] The time since the shape came, by the node's own clock. The stamp does not count: the
  /// sender's clock may differ. (Before the first /clock, messages come at time zero. Of these, the
  /// stamp counts.)
  double age(ros::Time now) const {
    return now.toSec() - (received.isZero() ? stamp : received).toSec();
  }
};

/// A named organ: its frame and its latest shape, which has the one before.
class DeformableOrgan {
 public:
  DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh, ros::Time stamp,
                  ros::Time received);

  const std::string& name() const { return name_; }
  const std::string& frame() const { return frame_; }
  const OrganShape& latest() const { return latest_; }
  /// What is known of the surface. After the triangles have changed, this returns another object.
  const std::shared_ptr<OrganSurface>& surface() const { return latest_.surface; }

  /// Sets new positions for the same triangles. Throws MeshError, and changes nothing, if the
  /// vertices do not fit. Uses the memory of a shape again that nobody uses any more, if there is
  /// one: this saves a large organ the allocation of its boxes for each shape.
  void move(SharedVertices vertices, ros::Time stamp, ros::Time received);
  /// Sets a new mesh with other triangles.
  void replace(TriangleMesh mesh, ros::Time stamp, ros::Time received);

  void set_frame(std::string frame) { frame_ = std::move(frame); }
  const History& history() const { return history_; }
  /// Begins another history. `with_latest`: the latest shape is the first one that belongs to it;
  /// otherwise, the next one will be.
  void begin(History history, bool with_latest) {
    history_ = std::move(history);
    latest_.before.reset();
    if (with_latest) latest_.history = history_.number;
  }
  /// If the latest shape was received later than `now`, or before the clock began, it counts as
  /// received at `now`.
  void limit_received(ros::Time now);

 private:
  std::string name_;
  std::string frame_;
  OrganShape latest_;
  History history_;
  std::vector<std::shared_ptr<TriangleMesh>> shapes_;  ///< all with the present triangles
};

// These functions tell users about an organ.

/// "closed", "open (12 edges)", or "not yet known". An open edge has no opposite edge.
std::string closedness(const OrganSurface& surface);
/// "outward" or "inward" for a closed surface, "none" for an open one. "not yet known" until find()
/// is done.
std::string orientation(const OrganSurface& surface);
/// A summary, for example "organ 'kidney': 2208 faces, closed, 0.12 x 0.09 x 0.06 m".
std::string summary(const std::string& organ, const OrganSurface& surface);
/// Sentences about what is legal, but probably a mistake: the organ's size, and faces that point
/// inward. `box`: the box around the organ [m].
std::vector<std::string> doubts(const std::string& organ, const Eigen::AlignedBox3d& box,
                                const OrganSurface& surface);
/// Everything about the organ's latest shape. Takes milliseconds for the volume of a large mesh.
/// Calls OrganSurface::find(), which only one thread may do.
OrganInfo info_of(const DeformableOrgan& organ);

/// Logs which surfaces came.
class SurfaceLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The shortest time between two summaries of an organ in the log, and between two warnings about
  /// it: in cutting, for example, the triangles change all the time.
  static constexpr std::chrono::seconds kPeriod{5};

  /// Logs the summary of a surface, and what is doubtful about it. The surface must be found.
  void tell(const std::string& organ, const OrganSurface& surface, Time now);

 private:
  struct Next {
    Time summary{}, doubts{};  ///< earliest times of the next messages
  };
  std::map<std::string, Next> next_;  ///< for each organ
};

}  // namespace organ_collision
