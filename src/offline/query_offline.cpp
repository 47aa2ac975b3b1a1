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

/// The contacts of all motions as CSV. They are printed only after all input has proved legal.
std::string evaluate(const Options& options) {
  const ObjMesh organ = read_obj(options.mesh);
  std::optional<ObjMesh> before;
  if (!options.mesh_before.empty()) {
    before = read_obj(options.mesh_before);
    check_same_faces(*before, organ);
  }
  const std::vector<Motion> motions = read_motions(options.motions);

  CollisionQuery query(options.picker);
  CollisionResult result;
  Progress progress(motions.size());
  std::string csv = contacts_header();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    progress.report(i);
    CollisionRequest request;
    request.organ = &organ.mesh;
    request.organ_before = before ? &before->mesh : nullptr;
    request.path = motions[i].path;
    request.radius = motions[i].radius;
    request.mode = motions[i].mode;
    try {
      query.evaluate(request, result);
    } catch (const std::invalid_argument& error) {
      throw InputError(options.motions, motions[i].line, error.what());
    }
    append_contacts(motions[i], result, csv);
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
