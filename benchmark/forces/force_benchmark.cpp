// How long the contact adapter takes from an answer to a wrench, by the number of contacts.

#include <benchmark/benchmark.h>
#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "common/messages/conversions.hpp"
#include "contact_adapter/force_law.hpp"

namespace organ_collision::bench {
namespace {

constexpr double kRadius = 0.005;  // [m]

/// `count` contacts, spread evenly over the lower half of a ball. In tight tissue all have the same
/// depth. Otherwise the ball is pressed down into a dent of its own shape, so that the depth grows
/// from the rim of the dent to its bottom.
ContactArray half_sphere(std::uint32_t count, bool is_tight) {
  constexpr double kGoldenAngle = 2.399963229728653;  // [rad]
  ContactArray answer;
  answer.links = {""};
  answer.mode = ContactArray::SWEPT;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double down = (i + 0.5) / count, across = std::sqrt(1.0 - down * down);
    const Eigen::Vector3d normal(across * std::cos(kGoldenAngle * i),
                                 across * std::sin(kGoldenAngle * i), -down);
    Contact contact;
    contact.face = i;
    contact.vertices = {3 * i, 3 * i + 1, 3 * i + 2};
    contact.barycentric = {0.2, 0.3, 0.5};
    contact.normal = to_vector(normal);
    contact.depth = is_tight ? 0.001 : 0.001 * down;
    contact.point = contact.on_organ =
        tf2::toMsg(Eigen::Vector3d((kRadius - contact.depth) * normal));
    answer.contacts.push_back(contact);
  }
  return answer;
}

void run(benchmark::State& state, bool is_tight) {
  const ContactArray answer = half_sphere(static_cast<std::uint32_t>(state.range(0)), is_tight);
  ForceLaw law;
  for ([[maybe_unused]] const auto _ : state) {
    benchmark::DoNotOptimize(law.follow(answer, 0.001, 300.0, kRadius));
  }
}

BENCHMARK_CAPTURE(run, dent, false)
    ->Arg(1000)
    ->Arg(10'000)
    ->Arg(30'000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, tight, true)
    ->Arg(1000)
    ->Arg(10'000)
    ->Arg(30'000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace organ_collision::bench

BENCHMARK_MAIN();
