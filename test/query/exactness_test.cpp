// Short runs of exactness_proof with each picker: contacts, clearances and placements of every kind
// of core, at rest and in motion, agree with exact arithmetic.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "scenes.hpp"
#include "test/proof/exactness_proof.hpp"

namespace organ_collision {
namespace {

class Exactness : public testing::TestWithParam<std::tuple<PickerKind, oracle::Proof>> {};

TEST_P(Exactness, IsProvenForAllKindsOfTrials) {
  const auto& [picker, proof] = GetParam();
  oracle::Progress progress;
  EXPECT_TRUE(proof.prove({3000, 1, {picker}}, progress));
}

INSTANTIATE_TEST_SUITE_P(Proofs, Exactness,
                         testing::Combine(testing::ValuesIn(picker_kinds()),
                                          testing::ValuesIn(oracle::kProofs)),
                         [](const auto& proof) {
                           return std::get<1>(proof.param).name + std::string("_") +
                                  std::to_string(static_cast<int>(std::get<0>(proof.param)));
                         });

}  // namespace
}  // namespace organ_collision
