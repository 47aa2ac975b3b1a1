#pragma once

namespace faulty_osmesa {

/// What can go wrong with OpenGL while a query runs.
enum class Fault {
  kNone,
  kReportsError,    ///< glGetError tells an error after the draw
  kDrawsNothing,    ///< all calls succeed, and nothing is drawn
  kReturnsTooMuch,  ///< more floats or hits than the buffer can hold
  kReturnsGarbage,  ///< the buffer begins with what GL never writes
  kIsTaken,         ///< another context is made current in the thread, before the draw
  kStaysAway        ///< the context cannot be made current
};

enum class Duration { kOnce, kForGood };

/// Lets the fault befall the draw of this number, counted from 0 from now on, or that draw and all
/// later ones. kStaysAway befalls the attempts to make a context current, with the same numbers.
void befall(Fault fault, int number, Duration duration = Duration::kOnce);

/// Whether the last fault has befallen.
bool has_befallen();

/// How many contexts were created and not destroyed.
int living_contexts();

}  // namespace faulty_osmesa
