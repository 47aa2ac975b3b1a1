#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/parameters/parameter_table.hpp"
#include "test/refusals.hpp"

namespace organ_collision {

// The tests of every node's table of parameters. A node's tests define legal_parameters() and
// instantiate the suite.

/// The value of a private namespace that has the required parameters only.
template <typename Parameters>
XmlRpc::XmlRpcValue legal_parameters();

/// The error for the required parameters and `name` set to `value`; "accepted" if there is none.
template <typename Parameters>
std::string refusal_of(const std::string& name, const XmlRpc::XmlRpcValue& value) {
  XmlRpc::XmlRpcValue all = legal_parameters<Parameters>();
  all[name] = value;
  return refusal_by<ParameterError>([&] { parse_parameters<Parameters>(all); });
}

template <typename Parameters>
class ParameterTableTest : public testing::Test {
 protected:
  using XmlRpcValue = XmlRpc::XmlRpcValue;

  /// This value, as a parameter of the row's type.
  static XmlRpcValue typed(const ParameterTable::Row& row, double value) {
    if (row.is_flag()) return value != 0.0;
    if (row.is_whole()) return static_cast<int>(value);
    return value;
  }

  /// A legal value that is not the default.
  static double other_value(const ParameterTable::Row& row) {
    if (row.is_flag()) return 1.0 - row.value();
    return std::isinf(row.range.highest) ? row.range.lowest + 0.75 : row.range.highest;
  }

  /// Values outside of the range, or of another type.
  static std::vector<XmlRpcValue> illegal_values(const ParameterTable::Row& row) {
    XmlRpcValue list;
    list.setSize(1);
    std::vector<XmlRpcValue> illegal{"text", list};
    if (row.is_flag()) {
      illegal.emplace_back(1);
      return illegal;
    }
    const NumberRange& range = row.range;
    std::vector<double> numbers{range.lowest - 1.0};
    if (!range.lowest_is_legal) numbers.push_back(range.lowest);
    if (!std::isinf(range.highest)) numbers.push_back(range.highest + 1.0);
    if (range.least_above_zero > 0.0) numbers.push_back(1e-10);
    for (const double number : numbers) illegal.push_back(typed(row, number));
    for (const double number : {std::nan(""), -kUnlimited}) illegal.emplace_back(number);
    if (!range.infinity_is_legal) illegal.emplace_back(kUnlimited);
    return illegal;
  }

  Parameters defaults_;
  const ParameterTable table_ = table_of(defaults_);
};

TYPED_TEST_SUITE_P(ParameterTableTest);

TYPED_TEST_P(ParameterTableTest, EveryNumberAndFlagIsTakenOrNamed) {
  for (const ParameterTable::Row& row : this->table_.rows()) {
    EXPECT_FALSE(row.text.empty()) << row.name;
    if (!row.is_flag() && !row.is_number()) continue;
    XmlRpc::XmlRpcValue all = legal_parameters<TypeParam>();
    const double other = this->other_value(row);
    EXPECT_NE(other, row.value()) << row.name;
    all[row.name] = this->typed(row, other);
    TypeParam taken = parse_parameters<TypeParam>(all);
    EXPECT_TRUE(taken.misspelt.empty()) << row.name;
    const ParameterTable table = table_of(taken);
    for (std::size_t i = 0; i < table.rows().size(); ++i) {
      const ParameterTable::Row& now = table.rows()[i];
      EXPECT_EQ(now.value(), now.name == row.name ? other : this->table_.rows()[i].value())
          << now.name;
    }
    if (row.range.lowest_is_legal) {
      EXPECT_EQ(refusal_of<TypeParam>(row.name, this->typed(row, row.range.lowest)), "accepted");
    }
    for (const XmlRpc::XmlRpcValue& illegal : this->illegal_values(row)) {
      const bool is_entry = row.list && illegal.getType() == XmlRpc::XmlRpcValue::TypeArray;
      expect_words(refusal_of<TypeParam>(row.name, illegal),
                   {"~" + row.name + (is_entry ? "[0] is " : " is "), "; must be "});
    }
  }
}

TYPED_TEST_P(ParameterTableTest, OnlyLiveOnesCanBeChangedAndTheRestStays) {
  const std::vector<ParameterTable::Row> live = this->table_.live_rows();
  if (live.empty()) return;  // The node serves no changes.
  for (const ParameterTable::Row& row : this->table_.rows()) {
    XmlRpc::XmlRpcValue change;
    change[row.name] = this->typed(row, this->other_value(row));
    if (!row.is_live) {
      EXPECT_THROW(this->table_.change(change), ParameterError) << row.name;
      continue;
    }
    TypeParam parameters;
    const ParameterTable table = table_of(parameters);
    table.change(change);
    for (const ParameterTable::Row& now : table.live_rows()) {
      EXPECT_EQ(now.value(), now.name == row.name ? this->other_value(row) : now.fallback)
          << now.name;
    }
    // A change with an illegal value changes nothing, also not the parameters before it.
    for (const ParameterTable::Row& other : live) {
      change[other.name] = this->typed(other, this->other_value(other));
    }
    for (const XmlRpc::XmlRpcValue& illegal : this->illegal_values(row)) {
      change[row.name] = illegal;
      EXPECT_THROW(this->table_.change(change), ParameterError) << row.name;
      for (const ParameterTable::Row& kept : live) EXPECT_EQ(kept.value(), kept.fallback);
    }
  }
}

TYPED_TEST_P(ParameterTableTest, MisspeltNamesAreReported) {
  for (const ParameterTable::Row& row : this->table_.rows()) {
    XmlRpc::XmlRpcValue all = legal_parameters<TypeParam>();
    all[row.name + "_"] = 1;
    const std::vector<std::string> misspelt = parse_parameters<TypeParam>(all).misspelt;
    ASSERT_EQ(misspelt.size(), 1u);
    expect_words(misspelt[0], {"~" + row.name + "_ is no parameter; nearest is '"});
  }
}

REGISTER_TYPED_TEST_SUITE_P(ParameterTableTest, EveryNumberAndFlagIsTakenOrNamed,
                            OnlyLiveOnesCanBeChangedAndTheRestStays, MisspeltNamesAreReported);

}  // namespace organ_collision
