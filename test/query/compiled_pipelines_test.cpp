// Mesa compiles its vertex pipeline with LLVM, for some 20 ms. A query that does so stalls the loop
// it is in. This program counts the modules that LLVM makes: Mesa's calls reach the function below
// instead of the one in LLVM's library.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <link.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <tuple>

#include "scenes.hpp"
#include "test/grid_surface.hpp"

namespace {

int modules = 0;

/// The library of LLVM that Mesa has loaded.
void* loaded_llvm() {
  void* library = nullptr;
  const auto take = [](dl_phdr_info* info, std::size_t /*size*/, void* result) {
    if (std::strstr(info->dlpi_name, "libLLVM") == nullptr) return 0;
    *static_cast<void**>(result) = dlopen(info->dlpi_name, RTLD_NOW | RTLD_NOLOAD);
    return 1;
  };
  dl_iterate_phdr(take, &library);
  return library;
}

}  // namespace

extern "C" void* LLVMModuleCreateWithNameInContext(const char* name, void* context) {
  using Create = void*(const char*, void*);
  static const auto create =
      reinterpret_cast<Create*>(dlsym(loaded_llvm(), "LLVMModuleCreateWithNameInContext"));
  if (create == nullptr) std::abort();
  ++modules;
  return create(name, context);
}

namespace organ_collision {
namespace {

class CompiledPipelines : public testing::TestWithParam<std::tuple<PickerKind, GlPlatform>> {
 protected:
  CompiledPipelines() {
    modules = 0;
    query_.emplace(PickerSettings(std::get<0>(GetParam()), std::get<1>(GetParam())));
    EXPECT_GT(modules, 0) << "a new query compiles its pipeline, or modules are not counted";
    modules = 0;
  }

  /// Evaluates the request in all modes that it has an answer for.
  void evaluate(CollisionRequest& request) {
    for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                                 QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
      request.mode = mode;
      try {
        query_->evaluate(request, result_);
        ++answers_;
        contacts_ += result_.contacts.size();
      } catch (const std::invalid_argument&) {  // The paper's volumes do not exist for all tools.
      }
    }
  }

  std::optional<CollisionQuery> query_;
  CollisionResult result_;
  std::size_t answers_ = 0, contacts_ = 0;
};

// The arrays that GL reads move in memory as they grow.
TEST_P(CompiledPipelines, AreEnoughWhenMoreAndMoreFacesAreDrawn) {
  for (int size = 2; size <= 256; size *= 2) {
    const GridSurface grid = grid_surface(size, 0.0);
    const TriangleMesh organ(grid.vertices, grid.triangles());
    CollisionRequest request = swept(
        organ,
        {{0.0, {{0.0, 0.0, 0.3}, {-0.1, 0.0, 0.0}}}, {1.0, {{0.0, 0.0, 0.3}, {0.1, 0.01, 0.0}}}},
        0.005);
    evaluate(request);
    EXPECT_EQ(modules, 0) << "in a query with " << organ.face_count() << " faces";
    modules = 0;
  }
  EXPECT_EQ(answers_, 8 * 5U);
  EXPECT_GT(contacts_, 1000U);
}

TEST_P(CompiledPipelines, AreEnoughForQueriesOfAllKinds) {
  oracle::Random random(54);
  const TriangleMesh large_organ = mesh(scattered_faces(3000, random));
  for (int i = 0; i < 200; ++i) {
    LinkScene scene(true, random);
    scene.request.regions = random.chance(0.5);
    if (random.chance(0.3)) {
      scene.request.organ = &large_organ;
      scene.request.organ_before = nullptr;
    }
    evaluate(scene.request);
    if (scene.request.radius > 0.0) {
      scene.request.path = random_path(false, random);
      scene.request.links = nullptr;
      evaluate(scene.request);
    }
    EXPECT_EQ(modules, 0) << "in scene " << i;
    modules = 0;
  }
  EXPECT_GT(answers_, 500U);
  EXPECT_GT(contacts_, 1000U);
}

// In the paper's volume of a tool that moves nearly along its axis, rounding loses the face that
// shows that GL works. GL then draws once more.
TEST_P(CompiledPipelines, AreEnoughWhereTheWitnessIsLost) {
  oracle::Random random(55);
  const TriangleMesh organ = mesh(liver());
  for (int i = 0; i < 200; ++i) {
    const ShaftAxis from = random_axis(random);
    ShaftAxis to = from;
    to.tip += random.scale(1e-4, 0.1) * (from.tip - from.trocar).normalized();
    to.tip += random.scale(1e-12, 1e-5) * random.direction();
    CollisionRequest request = swept(organ, {{0.0, from}, {1.0, to}}, random.scale(1e-4, 0.01));
    evaluate(request);
    EXPECT_EQ(modules, 0) << "in motion " << i;
    modules = 0;
  }
  EXPECT_GT(answers_, 500U);
}

std::string name(const testing::TestParamInfo<CompiledPipelines::ParamType>& info) {
  const bool feedback = std::get<0>(info.param) == PickerKind::kFeedback;
  const bool osmesa = std::get<1>(info.param) == GlPlatform::kOsmesa;
  return std::string(feedback ? "Feedback" : "Select") + (osmesa ? "OnOsmesa" : "OnEgl");
}

INSTANTIATE_TEST_SUITE_P(Pickers, CompiledPipelines,
                         testing::Combine(testing::Values(PickerKind::kFeedback,
                                                          PickerKind::kSelect),
                                          testing::Values(GlPlatform::kOsmesa, GlPlatform::kEgl)),
                         name);

}  // namespace
}  // namespace organ_collision
