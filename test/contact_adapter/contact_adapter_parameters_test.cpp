#include "contact_adapter/contact_adapter_parameters.hpp"

#include "test/ros/parameters/parameter_tables.hpp"

namespace organ_collision {

template <>
XmlRpc::XmlRpcValue legal_parameters<ContactAdapterParameters>() {
  XmlRpc::XmlRpcValue all;
  all.begin();  // Makes it an empty group.
  return all;
}

INSTANTIATE_TYPED_TEST_SUITE_P(ContactAdapter, ParameterTableTest, ContactAdapterParameters);

namespace {

TEST(ContactAdapterParameters, TheForceIsUnlimitedByDefault) {
  const auto p =
      parse_parameters<ContactAdapterParameters>(legal_parameters<ContactAdapterParameters>());
  EXPECT_EQ(p.max_force, kUnlimited);
  EXPECT_EQ(refusal_of<ContactAdapterParameters>("max_force", 0),
            "~max_force is '0'; must be a number, more than 0, or .inf");
}

}  // namespace
}  // namespace organ_collision
