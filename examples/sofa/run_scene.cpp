// Runs a scene without graphics, step by step in real time, until Ctrl-C: run_scene SCENE. Steps
// that take longer than their time in the scene follow each other without a pause. SOFA_ROOT names
// the folder where SOFA is installed.

#include <sofa/simulation/Node.h>
#include <sofa/simulation/Simulation.h>
#include <sofa/simulation/common/init.h>
#include <sofa/simulation/graph/init.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>
#include <thread>

namespace {
volatile std::sig_atomic_t is_ended = 0;
}

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: run_scene SCENE\n";
    return 2;
  }
  std::signal(SIGINT, [](int) { is_ended = 1; });
  std::signal(SIGTERM, [](int) { is_ended = 1; });
  sofa::simulation::common::init();
  sofa::simulation::graph::init();
  const auto root = sofa::simulation::node::load(argv[1]);
  if (!root) return 1;
  sofa::simulation::node::initRoot(root.get());
  auto next = std::chrono::steady_clock::now();
  while (!is_ended) {
    sofa::simulation::node::animate(root.get(), root->getDt());
    next += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(root->getDt()));
    next = std::max(next, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
  sofa::simulation::node::unload(root);
  sofa::simulation::common::cleanup();
  sofa::simulation::graph::cleanup();
}
