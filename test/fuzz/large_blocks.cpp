// Keeps large blocks of memory for the next request. assimp fills buffers of 2 and 16 MB for each
// file that it reads. AddressSanitizer gets new pages for each of them from the kernel, which takes
// ten times as long as all else that reading a small file needs.
#include <malloc.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <new>

namespace {

constexpr std::size_t kLarge = 128 * 1024;  // [bytes]

std::mutex mutex;
std::array<void*, 8> kept{};

void* take_kept(std::size_t size) {
  const std::lock_guard lock(mutex);
  for (void*& block : kept) {
    if (block == nullptr) continue;
    const std::size_t found = malloc_usable_size(block);
    if (found < size || found / 2 > size) continue;
    void* const taken = block;
    block = nullptr;
    return taken;
  }
  return nullptr;
}

bool keep(void* block) {
  const std::lock_guard lock(mutex);
  for (void*& place : kept) {
    if (place != nullptr) continue;
    place = block;
    return true;
  }
  return false;
}

}  // namespace

/// The other operators `new` remain those of the sanitizer, which distinguishes them from malloc.
extern "C" const char* __asan_default_options();  // NOLINT: the sanitizer's name
extern "C" const char* __asan_default_options() { return "alloc_dealloc_mismatch=0"; }

void* operator new(std::size_t size) {
  if (size >= kLarge) {
    if (void* const block = take_kept(size)) return block;
  }
  if (void* const block = std::malloc(size > 0 ? size : 1)) return block;
  throw std::bad_alloc();
}

void operator delete(void* block) noexcept {
  const bool is_large = block != nullptr && malloc_usable_size(block) >= kLarge;
  if (!is_large || !keep(block)) std::free(block);
}

void operator delete(void* block, std::size_t /*size*/) noexcept { operator delete(block); }
