#include "memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace organ_collision {
namespace {

void check(bool succeeded, const char* what) {
  if (!succeeded) throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

MemoryFile::MemoryFile() : descriptor_(memfd_create("fuzz_input", MFD_CLOEXEC)) {
  check(descriptor_ >= 0, "memfd_create");
}

MemoryFile::~MemoryFile() { close(descriptor_); }

void MemoryFile::write(const std::string& content) {
  check(ftruncate(descriptor_, 0) == 0, "ftruncate");
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t count =
        pwrite(descriptor_, &content[done], content.size() - done, static_cast<off_t>(done));
    check(count > 0, "pwrite");
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace organ_collision
