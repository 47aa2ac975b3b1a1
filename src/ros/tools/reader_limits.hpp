#pragma once

#include <chrono>
#include <cstddef>

/// What reading a robot's description may take. The first three bind robot_reader, which sets them
/// itself; the others are the node's, for what it gets from there.
namespace organ_collision::reader_limits {

/// Of the URDF, and of each mesh file. A mesh of two million triangles, as STL.
inline constexpr std::size_t kFileBytes = 100'000'000;
/// Of address space: a file, what its reader makes of it, and what is sent to the node.
inline constexpr std::size_t kMemoryBytes = std::size_t{2} << 30;
/// Of processor time: files at the limit above take a few seconds.
inline constexpr std::chrono::seconds kProcessorTime{10};

/// Of real time: on a busy machine, processor time comes slowly.
inline constexpr std::chrono::seconds kTime{30};
inline constexpr std::size_t kReplyBytes = 500'000'000;

}  // namespace organ_collision::reader_limits
