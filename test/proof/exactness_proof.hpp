#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "clearance_trials.hpp"
#include "organ_collision/query/collision_query.hpp"

/// Each proof compares random trials of one kind of answer with the oracles.
namespace organ_collision::oracle {

/// Prints a line on stderr about once a second.
class Progress {
 public:
  void show(const std::string& what, long done, long all);

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// How often the library and an oracle agreed: counts, and largest errors, by the names of their
/// columns.
class Tally {
 public:
  void count(const char* column, long number) { at(column, true) += static_cast<double>(number); }
  void keep_most(const char* column, double value);
  void add(const Tally& other);
  /// Zero if there is no such column.
  double get(const std::string& column) const;

 private:
  struct Column {
    std::string name;
    bool is_count;
    double value;
  };
  double& at(const std::string& column, bool is_count);

  std::vector<Column> columns_;  ///< in the order in which they were first used

  friend void print_table(const std::string&, const std::vector<std::string>&,
                          const std::vector<Tally>&);
};

/// Prints a table in Markdown with a line for each name, and one for their sum.
void print_table(const std::string& what, const std::vector<std::string>& names,
                 const std::vector<Tally>& tallies);

/// The sum of the lines of a table.
Tally sum_of(const std::vector<Tally>& tallies);

/// How much a proof compares.
struct ProofSize {
  long pairs = 1000000;    ///< trials: pairs of a face and a motion
  unsigned long seed = 1;  ///< The same seed gives the same trials.
  /// Contacts are compared with all of these, and other answers with the first one.
  std::vector<PickerKind> pickers = picker_kinds();
};

/// Asks the library and the oracles how far a tool is from an organ. Prints the trial if the
/// answers differ by more than 1e-9 m at the end of the step, or 1e-6 m during it. The tally counts
/// it as "wrong".
Tally compare_clearance(const ClearanceTrial& trial, CollisionQuery& query);

// Each prints tables, and the trials in which library and oracle differ by more than the stated
// tolerance. It returns whether there are none.

bool prove_contacts(const ProofSize& size, Progress& progress);
/// A tenth of the trials have a tool that moves.
bool prove_clearance(const ProofSize& size, Progress& progress);
/// Sides and crossings; and the clearance of the same tools.
bool prove_placement(const ProofSize& size, Progress& progress);
/// Jaws close on tissue, a tenth as often: what they grasp is compared with all pairs of contacts.
bool prove_grasps(const ProofSize& size, Progress& progress);
/// Prints how many of the faces that a swept capsule touches are missed by the paper's volume.
/// Returns whether ours misses none.
bool count_paper_misses(const ProofSize& size, Progress& progress);

struct Proof {
  const char* name;
  bool (*prove)(const ProofSize& size, Progress& progress);
};
inline constexpr Proof kProofs[] = {{"contacts", prove_contacts},
                                    {"clearance", prove_clearance},
                                    {"placement", prove_placement},
                                    {"grasps", prove_grasps}};

}  // namespace organ_collision::oracle
