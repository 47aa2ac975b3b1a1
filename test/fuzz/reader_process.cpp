#include "reader_process.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>

#include "fuzz_input.hpp"
#include "robot_reader/resource.hpp"
#include "robot_reader/robot_model.hpp"

// Large blocks of memory are kept for the next request. assimp fills buffers of 2 and 16 MB for
// each file that it reads. AddressSanitizer gets new pages for each of them from the kernel, which
// takes ten times as long as all else that reading a small file needs.
namespace {

constexpr std::size_t kLarge = 128 * 1024;  // [bytes]

bool keeps_large_blocks = false;  ///< Only the process that reads mesh files does.
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
  if (keeps_large_blocks && size >= kLarge) {
    if (void* const block = take_kept(size)) return block;
  }
  if (void* const block = std::malloc(size > 0 ? size : 1)) return block;
  throw std::bad_alloc();
}

void operator delete(void* block) noexcept {
  const bool is_large =
      keeps_large_blocks && block != nullptr && malloc_usable_size(block) >= kLarge;
  if (!is_large || !keep(block)) std::free(block);
}

void operator delete(void* block, std::size_t /*size*/) noexcept { operator delete(block); }

namespace organ_collision {
namespace {

constexpr int kRequests = 500;  ///< of one process
/// [ms] After so much real time, reading a file hangs. It is long, because other programs may keep
/// the processors busy.
constexpr int kHangs = 50'000;

// Requests and answers are blocks: their size, and so many bytes. An empty block ends an answer.
// libFuzzer's timer interrupts what waits for them, which then begins again.

bool write_all(int descriptor, const void* data, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t count =
        TEMP_FAILURE_RETRY(write(descriptor, static_cast<const char*>(data) + done, size - done));
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

bool write_block(int descriptor, const std::string& block) {
  const std::uint64_t size = block.size();
  return write_all(descriptor, &size, sizeof(size)) &&
         write_all(descriptor, block.data(), block.size());
}

/// False: the other process has ended.
bool read_all(int descriptor, void* data, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t count =
        TEMP_FAILURE_RETRY(read(descriptor, static_cast<char*>(data) + done, size - done));
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

bool read_block(int descriptor, std::string& block) {
  std::uint64_t size = 0;
  if (!read_all(descriptor, &size, sizeof(size))) return false;
  block.resize(size);
  return read_all(descriptor, block.data(), size);
}

/// A crash ends the process at once, without reports of those who catch signals.
[[noreturn]] void serve(int input, int output) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM}) {
    std::signal(signal, SIG_DFL);
  }
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
  limit_process();
  keeps_large_blocks = true;
  for (std::string urdf; read_block(input, urdf);) {
    answer_with_links([&] { return urdf; }, {"tip"},
                      [&](const std::string& record) {
                        if (!write_block(output, record)) _exit(EXIT_FAILURE);
                      });
    if (!write_block(output, "")) break;
  }
  _exit(EXIT_SUCCESS);
}

}  // namespace

std::string ReaderProcess::read(const std::string& urdf) {
  if (requests_ == kRequests) end();
  const bool is_used = process_ >= 0;
  const std::string answer = ask(urdf);
  const bool has_died = process_ < 0;
  return is_used && has_died ? ask(urdf) : answer;
}

std::string ReaderProcess::ask(const std::string& urdf) {
  if (process_ < 0) start();
  ++requests_;
  std::string answer;
  bool lives = write_block(to_, urdf);
  for (std::string record; lives;) {
    pollfd ready{from_, POLLIN, 0};
    demand(TEMP_FAILURE_RETRY(poll(&ready, 1, kHangs)) == 1, "reading a file ends");
    lives = read_block(from_, record);
    if (!lives || record.empty()) break;
    answer += record;
  }
  if (!lives) end();
  return answer;
}

void ReaderProcess::start() {
  int requests[2], answers[2];
  demand(pipe2(requests, O_CLOEXEC) == 0 && pipe2(answers, O_CLOEXEC) == 0, "there are pipes");
  std::signal(SIGPIPE, SIG_IGN);
  process_ = fork();
  demand(process_ >= 0, "there is a process");
  if (process_ == 0) {
    close(requests[1]);
    close(answers[0]);
    serve(requests[0], answers[1]);
  }
  close(requests[0]);
  close(answers[1]);
  to_ = requests[1];
  from_ = answers[0];
  requests_ = 0;
}

void ReaderProcess::end() {
  if (process_ < 0) return;
  close(to_);
  close(from_);
  int status = 0;
  TEMP_FAILURE_RETRY(waitpid(process_, &status, 0));
  demand(!WIFSIGNALED(status) || WTERMSIG(status) != SIGXCPU, "reading a file ends soon");
  process_ = -1;
}

}  // namespace organ_collision
