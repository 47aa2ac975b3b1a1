// The CSV files with motions of query_offline. The motions are answered, too.
#include "fuzz_input.hpp"
#include "memory_file.hpp"
#include "offline/motions.hpp"
#include "offline/text_reader.hpp"

using namespace organ_collision;

namespace {

/// [motions] Of an input that are answered.
constexpr int kMost = 10;

void answer(const Motion& motion) {
  static const TriangleMesh organ({-1, -1, 0, 1, -1, 0.1f, 1, 1, 0, -1, 1, 0.2f},
                                  {0, 1, 2, 0, 2, 3});
  static CollisionQuery query(PickerKind::kFeedback);
  CollisionRequest request;
  request.organ = &organ;
  request.mode = motion.mode;
  request.path = path_of(motion);
  request.radius = motion.radius;
  CollisionResult result;
  query.evaluate(request, result);
  for (const FaceContact& contact : result.contacts) {
    demand(contact.face < 2, "a contact's face exists");
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static MemoryFile file;
  file.write(FuzzInput(data, size).rest());
  try {
    MotionList(file.path(), MotionList::Order::kAsInFile);
    MotionList motions(file.path(), MotionList::Order::kByQuery);
    demand(motions.size() > 0, "a legal file has a motion");
    for (int i = 0; i < kMost; ++i) {
      const std::optional<Motion> motion = motions.next();
      if (!motion) break;
      answer(*motion);
    }
  } catch (const InputError&) {
  }
  return 0;
}
