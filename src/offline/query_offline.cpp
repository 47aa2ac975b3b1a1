#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "contacts_csv.hpp"
#include "input_error.hpp"
#include "motions_reader.hpp"
#include "obj_reader.hpp"
#include "options.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "progress.hpp"

namespace organ_collision {
namespace {

/// The shapes of the organ that all motions meet.
struct Organ {
  ObjMesh now;
  std::optional<ObjMesh> before;
  std::optional<SurfaceTopology> topology;  ///< only if the placement is asked for
};

Organ read_organ(const Options& options) {
  Organ organ{read_obj(options.mesh), {}, {}};
  if (!options.mesh_before.empty()) {
    organ.before = read_obj(options.mesh_before);
    check_same_faces(*organ.before, organ.now);
  }
  if (options.placement) {
    organ.topology.emplace(organ.now.mesh.faces(), organ.now.mesh.vertices());
  }
  return organ;
}

CollisionRequest request_of(const Motion& motion, const Organ& organ, const Options& options) {
  CollisionRequest request;
  request.organ = &organ.now.mesh;
  request.organ_before = organ.before ? &organ.before->mesh : nullptr;
  request.path = motion.path;
  request.radius = motion.radius;
  request.mode = motion.mode;
  if (is_paper_mode(motion.mode)) return request;
  request.margin = options.margin;
  request.clearance = options.clearance;
  request.placement = options.placement;
  request.surface_topology = organ.topology ? &*organ.topology : nullptr;
  return request;
}

/// The answers to all motions as CSV. They are printed only after all input has proved legal.
std::string evaluate(const Options& options) {
  const Organ organ = read_organ(options);
  const std::vector<Motion> motions = read_motions(options.motions);

  CollisionQuery query(options.picker);
  CollisionResult result;
  Progress progress(motions.size());
  const AddedColumns added{options.margin > 0.0 || options.clearance, options.placement};
  std::string csv = contacts_header(added);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    progress.report(i);
    try {
      query.evaluate(request_of(motions[i], organ, options), result);
    } catch (const std::invalid_argument& error) {
      throw InputError(options.motions, motions[i].line, error.what());
    }
    append_contacts(motions[i], result, csv, added);
  }
  return csv;
}

void print(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  throw std::runtime_error(std::string("stdout cannot be written: ") + std::strerror(errno));
}

int run(const std::vector<std::string>& arguments) {
  try {
    const Options options = parse_options(arguments);
    print(options.help ? usage() : evaluate(options));
    return 0;
  } catch (const InputError& error) {
    std::cerr << error.what() << std::endl;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "query_offline: " << error.what() << std::endl;
    return 1;
  }
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  // A closed pipe on stdout is then reported like any other failed write.
  std::signal(SIGPIPE, SIG_IGN);
  return organ_collision::run({argv + 1, argv + argc});
}
