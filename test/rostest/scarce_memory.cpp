#include <cstdlib>
#include <new>

// Preloaded into a process, this makes `new` fail for blocks of more than a mebibyte.

namespace {

constexpr std::size_t kLargest = 1 << 20;

}  // namespace

void* operator new(std::size_t size) {
  void* const block = size <= kLargest ? std::malloc(size) : nullptr;
  if (!block) throw std::bad_alloc();
  return block;
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t /*size*/) noexcept { std::free(block); }
