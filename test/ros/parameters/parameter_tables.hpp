#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ros/parameters/parameter_table.hpp"

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
  try {
    parse_parameters<Parameters>(all);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

inline void expect_contains(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' in: " << message;
  }
}

template <typename Parameters>
class ParameterTableTest : public testing::Test {
 protected:
  using XmlRpcValue = XmlRpc::XmlRpcValue;

  /// A legal value that is not the default.
  static XmlRpcValue other_value(const ParameterTable::Row& row) {
    const NumberRange& range = row.range;
    switch (row.value().getType()) {
      case XmlRpcValue::TypeBoolean:
        return !static_cast<bool>(XmlRpcValue(row.value()));
      case XmlRpcValue::TypeInt:
        return static_cast<int>(range.highest);
      default:
        return std::isinf(range.highest) ? range.lowest + 0.75 : range.highest;
    }
  }

  /// Values outside of the range, or of another type.
  static std::vector<XmlRpcValue> illegal_values(const ParameterTable::Row& row) {
    XmlRpcValue list;
    list.setSize(1);
    std::vector<XmlRpcValue> illegal{"text", list};
    const NumberRange& range = row.range;
    const auto add = [&](double value) {
      if (row.value().getType() == XmlRpcValue::TypeInt) {
        illegal.emplace_back(static_cast<int>(value));
      } else {
        illegal.emplace_back(value);
      }
    };
    if (row.value().getType() == XmlRpcValue::TypeBoolean) {
      illegal.emplace_back(1);
      return illegal;
    }
    illegal.emplace_back(std::nan(""));
    illegal.emplace_back(-kUnlimited);
    if (!range.infinity_is_legal) illegal.emplace_back(kUnlimited);
    add(range.lowest - 1.0);
    if (!range.lowest_is_legal) add(range.lowest);
    if (!std::isinf(range.highest)) add(range.highest + 1.0);
    if (range.least_above_zero > 0.0) add(1e-10);
    return illegal;
  }

  Parameters defaults_;
  const ParameterTable table_ = table_of(defaults_);
};

TYPED_TEST_SUITE_P(ParameterTableTest);

TYPED_TEST_P(ParameterTableTest, EveryNumberAndFlagIsTaken) {
  for (const ParameterTable::Row& row : this->table_.rows()) {
    EXPECT_FALSE(row.help.text.empty()) << row.help.name;
    if (!row.value) continue;
    XmlRpc::XmlRpcValue all = legal_parameters<TypeParam>();
    const XmlRpc::XmlRpcValue other = this->other_value(row);
    EXPECT_NE(other, row.value()) << row.help.name;
    all[row.help.name] = other;
    TypeParam taken = parse_parameters<TypeParam>(all);
    EXPECT_TRUE(taken.misspelt.empty()) << row.help.name;
    const ParameterTable table = table_of(taken);
    for (std::size_t i = 0; i < table.rows().size(); ++i) {
      const ParameterTable::Row& now = table.rows()[i];
      if (!now.value) continue;
      EXPECT_EQ(now.value(),
                now.help.name == row.help.name ? other : this->table_.rows()[i].value())
          << now.help.name;
    }
  }
}

TYPED_TEST_P(ParameterTableTest, IllegalValuesAreNamed) {
  for (const ParameterTable::Row& row : this->table_.rows()) {
    if (!row.value) continue;
    for (const XmlRpc::XmlRpcValue& illegal : this->illegal_values(row)) {
      expect_contains(refusal_of<TypeParam>(row.help.name, illegal),
                      {"~" + row.help.name + " is '", "'; must be "});
    }
  }
}

TYPED_TEST_P(ParameterTableTest, OnlyLiveOnesCanBeChangedAndTheRestStays) {
  if (live_parameters(this->defaults_).empty()) return;  // The node serves no changes.
  for (const ParameterTable::Row& row : this->table_.rows()) {
    XmlRpc::XmlRpcValue change;
    change[row.help.name] = row.value ? this->other_value(row) : XmlRpc::XmlRpcValue("text");
    if (!row.is_live) {
      EXPECT_THROW(changed(this->defaults_, change), ParameterError) << row.help.name;
      continue;
    }
    for (const LiveParameter& now : live_parameters(changed(this->defaults_, change))) {
      EXPECT_EQ(now.value, now.name == row.help.name ? change[now.name] : now.fallback) << now.name;
    }
    for (const XmlRpc::XmlRpcValue& illegal : this->illegal_values(row)) {
      change[row.help.name] = illegal;
      EXPECT_THROW(changed(this->defaults_, change), ParameterError) << row.help.name;
    }
  }
}

TYPED_TEST_P(ParameterTableTest, MisspeltNamesAreReported) {
  for (const ParameterTable::Row& row : this->table_.rows()) {
    XmlRpc::XmlRpcValue all = legal_parameters<TypeParam>();
    all[row.help.name + "_"] = 1;
    const std::vector<std::string> misspelt = parse_parameters<TypeParam>(all).misspelt;
    ASSERT_EQ(misspelt.size(), 1u);
    expect_contains(misspelt[0], {"~" + row.help.name + "_ is no parameter; nearest is '"});
  }
}

REGISTER_TYPED_TEST_SUITE_P(ParameterTableTest, EveryNumberAndFlagIsTaken, IllegalValuesAreNamed,
                            OnlyLiveOnesCanBeChangedAndTheRestStays, MisspeltNamesAreReported);

}  // namespace organ_collision
