#pragma once

#include <sys/types.h>

#include <string>

namespace organ_collision {

/// A process that does the work of the program robot_reader, for one request after the other. It is
/// a copy of the fuzz target, because to start robot_reader takes 20 ms under a sanitizer. The
/// parsers of mesh files may end it; the next request then goes to a new one. So does each 500th,
/// because robot_reader's limit of processor time is for the whole process. A process that has read
/// other files before may end because of them. The request is then made once more.
class ReaderProcess {
 public:
  ReaderProcess() = default;
  ~ReaderProcess() { end(); }
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  /// What robot_reader writes about the link 'tip' of a robot (robot_reply.hpp). Ends this program,
  /// as demand() does, if the answer takes more than 50 s.
  std::string read(const std::string& urdf);

 private:
  /// Has no process afterwards if it has ended.
  std::string ask(const std::string& urdf);
  void start();
  void end();

  pid_t process_ = -1;  ///< negative: there is none
  int to_ = -1, from_ = -1;
  int requests_ = 0;
};

}  // namespace organ_collision
