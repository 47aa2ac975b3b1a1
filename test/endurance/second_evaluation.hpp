#pragma once

#include <organ_collision/ContactArray.h>

#include <optional>
#include <string>

#include "soak_script.hpp"

namespace organ_collision::soak {

/// An answer about the organ of the script, and the answer before it of the same tool, where its
/// step began. A static answer needs none.
struct AnsweredStep {
  ContactArrayConstPtr answer, before;
};

/// Why a step cannot be evaluated again; empty: it can. It is too long, so that the node may have
/// left out poses, or it begins or ends in a gap between poses.
std::string why_not_checkable(const Script& script, const AnsweredStep& step);

/// What is wrong with the contacts of an answer; empty: nothing; std::nullopt: the search could not
/// decide. The oracle of test/proof evaluates the step again, from the script alone: each contact
/// touches at its time, and no other face comes within the tool at any time of the step. Both by
/// exact distances or by a search that bounds them; up to 1e-7 m for shafts, and 1.1e-6 m for
/// links.
std::optional<std::string> wrong_contacts(const Script& script, const AnsweredStep& step);

}  // namespace organ_collision::soak
