// OpenGL's feedback buffer: any floats, of which GL says that it wrote any number.
#include <vector>

#include "fuzz_input.hpp"
#include "picking/gl/drawing.hpp"

using namespace organ_collision;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  // As GL: at most as many as the buffer has.
  const std::size_t spare = input.byte() % 16;
  std::vector<float> buffer;
  while (!input.empty()) buffer.push_back(input.number<float>());
  const std::size_t written = buffer.size() - std::min(spare, buffer.size());
  buffer.shrink_to_fit();
  std::size_t vertices = 0;
  double sum = 0.0;
  try {
    for_each_vertex(buffer, written, [&](const FeedbackVertex& vertex) {
      sum += vertex.window_depth() + vertex.face();
      ++vertices;
    });
  } catch (const GlError&) {
  }
  demand(vertices * FeedbackVertex::kFloats <= written, "each vertex is within the buffer");
  return 0;
}
