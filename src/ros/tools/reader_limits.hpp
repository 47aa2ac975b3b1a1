#pragma once

#include <chrono>
#include <cstddef>

/// What reading a robot's description may cost. The program robot_reader sets limits for
/// itself. The node enforces the last two on the program.
namespace organ_collision::reader_limits {

/// [bytes] Of the URDF, and of each mesh file. An STL file of two million triangles has this size.
inline constexpr std::size_t kFileBytes = 100'000'000;
/// [bytes] Of address space: a file, its parsed form, and the reply to the node.
inline constexpr std::size_t kMemoryBytes = std::size_t{2} << 30;
/// Of processor time: files of the largest legal size take a few seconds.
inline constexpr std::chrono::seconds kProcessorTime{10};
/// Of processor time for one mesh file: this, and some more for each byte. An OBJ file is read with
/// 30 MB a second. Parsers never stop reading some broken files.
inline constexpr std::chrono::milliseconds kMeshTime{200};
inline constexpr std::size_t kMeshBytesPerMillisecond = 2000;

/// Of real time, which is longer than processor time on a busy machine.
inline constexpr std::chrono::seconds kTime{30};
inline constexpr std::size_t kReplyBytes = 500'000'000;

}  // namespace organ_collision::reader_limits
