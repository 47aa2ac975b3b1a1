#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "evaluation.hpp"
#include "motions.hpp"
#include "options.hpp"
#include "shapes.hpp"
#include "text_reader.hpp"

namespace organ_collision {
namespace {

/// Writes at once, so that a reader who waits for an answer gets it.
void print(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  throw std::runtime_error(std::string("stdout cannot be written: ") + std::strerror(errno));
}

std::unique_ptr<ShapeSource> open_shapes(const Options& options) {
  if (!options.shapes.empty()) return std::make_unique<ShapeSequence>(shape_files(options.shapes));
  return std::make_unique<FixedShapes>(options.mesh, options.mesh_before);
}

/// Reads a file to its end, so that an illegal one is refused before anything is printed.
std::unique_ptr<MotionList> read_motions(const Options& options, const ShapeSource& shapes) {
  if (options.shapes.empty()) {
    return std::make_unique<MotionList>(options.motions, MotionList::Order::kByQuery);
  }
  auto motions = std::make_unique<MotionList>(options.motions, MotionList::Order::kAsInFile);
  if (motions->size() == shapes.remaining()) return motions;
  throw InputError(options.motions + ": the file has " + std::to_string(motions->size()) +
                   " motions; " + options.shapes + " has " + std::to_string(shapes.remaining()) +
                   " OBJ files, and each needs one motion");
}

/// `count`: of the motions, if it is known.
void answer_all(const Options& options, MotionSource& motions, std::optional<std::size_t> count,
                ShapeSource& shapes) {
  QueryWorkers threads(options.jobs, options.picker);
  Progress progress(count);
  std::size_t done = 0;
  Evaluation(options, motions, shapes, threads)
      .run([&](const std::string& csv, std::size_t answered) {
        print(csv);
        progress.report(done += answered);
      });
}

void evaluate(const Options& options) {
  const std::unique_ptr<ShapeSource> shapes = open_shapes(options);
  if (options.motions != kStandardInput) {
    const std::unique_ptr<MotionList> motions = read_motions(options, *shapes);
    return answer_all(options, *motions, motions->size(), *shapes);
  }
  MotionReader motions(StandardInput{});
  answer_all(options, motions, std::nullopt, *shapes);
  if (!motions.ends_within_line()) return;
  std::cerr << motions.name() << ":" << motions.line_number()
            << ": warning: the last line has no line feed; its end may be missing" << std::endl;
}

int run(const std::vector<std::string>& arguments) {
  try {
    const Options options = parse_options(arguments);
    if (options.help) {
      print(usage());
    } else {
      evaluate(options);
    }
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
