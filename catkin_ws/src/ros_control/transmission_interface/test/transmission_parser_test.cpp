// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <transmission_interface/transmission_parser.h>

#include <string>
#include <vector>

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using transmission_interface::TransmissionInfo;
using transmission_interface::TransmissionParser;

namespace {

const char* const kGoodJoint =
    "<joint name='j1'><hardwareInterface>hardware_interface/EffortJointInterface"
    "</hardwareInterface></joint>";
const char* const kGoodActuator = "<actuator name='m1'/>";

std::string robot(const std::string& content) {
  return "<?xml version='1.0'?><robot name='r'>" + content + "</robot>";
}

std::string transmission(const std::string& content) {
  return "<transmission name='t'><type>a/T</type>" + content + "</transmission>";
}

/// Transmissions of a robot with this content; the text itself must be accepted.
std::vector<TransmissionInfo> parsed(const std::string& content) {
  std::vector<TransmissionInfo> infos;
  EXPECT_TRUE(TransmissionParser::parse(robot(content), infos)) << content;
  return infos;
}

}  // namespace

TEST(TransmissionParser, RefusesTextThatIsNotXml) {
  std::vector<TransmissionInfo> infos;
  EXPECT_FALSE(TransmissionParser::parse("invalid urdf", infos));
  EXPECT_FALSE(TransmissionParser::parse("", infos));
  EXPECT_FALSE(TransmissionParser::parse("<robot><transmission></robot>", infos));
  EXPECT_THAT(infos, IsEmpty());
}

TEST(TransmissionParser, RefusesADocumentWithoutAnyElement) {
  std::vector<TransmissionInfo> infos;
  EXPECT_FALSE(TransmissionParser::parse("<!-- only a comment -->", infos));
  EXPECT_THAT(infos, IsEmpty());
}

TEST(TransmissionParser, AcceptsARobotWithoutTransmissions) {
  EXPECT_THAT(parsed("<link name='base'/>"), IsEmpty());
}

TEST(TransmissionParser, ReadsEveryField) {
  const auto infos = parsed(
      "<transmission name='arm'><type>franka_hw/FrankaStateInterface</type>"
      "<joint name='j1'><role>root</role><hardwareInterface>a/A</hardwareInterface>"
      "<hardwareInterface>b/B</hardwareInterface></joint>"
      "<joint name='j2'><role>tip</role><hardwareInterface>a/A</hardwareInterface></joint>"
      "<actuator name='m1'><hardwareInterface>c/C</hardwareInterface>"
      "<mechanicalReduction>50</mechanicalReduction></actuator>"
      "<actuator name='m2'/></transmission>");
  ASSERT_EQ(1u, infos.size());
  EXPECT_EQ("arm", infos[0].name_);
  EXPECT_EQ("franka_hw/FrankaStateInterface", infos[0].type_);
  ASSERT_EQ(2u, infos[0].joints_.size());
  EXPECT_EQ("j1", infos[0].joints_[0].name_);
  EXPECT_EQ("root", infos[0].joints_[0].role_);
  EXPECT_THAT(infos[0].joints_[0].hardware_interfaces_, ElementsAre("a/A", "b/B"));
  EXPECT_THAT(infos[0].joints_[0].xml_element_, HasSubstr("<role>root</role>"));
  EXPECT_EQ("j2", infos[0].joints_[1].name_);
  EXPECT_EQ("tip", infos[0].joints_[1].role_);
  ASSERT_EQ(2u, infos[0].actuators_.size());
  EXPECT_EQ("m1", infos[0].actuators_[0].name_);
  EXPECT_THAT(infos[0].actuators_[0].hardware_interfaces_, ElementsAre("c/C"));
  EXPECT_THAT(infos[0].actuators_[0].xml_element_,
              HasSubstr("<mechanicalReduction>50</mechanicalReduction>"));
  EXPECT_EQ("m2", infos[0].actuators_[1].name_);
  EXPECT_THAT(infos[0].actuators_[1].hardware_interfaces_, IsEmpty());
}

TEST(TransmissionParser, SerializedElementsAreXml) {
  const auto infos = parsed(
      transmission("<joint name='j&amp;1'><hardwareInterface>a/A</hardwareInterface></joint>" +
                   std::string(kGoodActuator)));
  ASSERT_EQ(1u, infos.size());
  EXPECT_EQ("j&1", infos[0].joints_[0].name_);
  TiXmlDocument again;
  again.Parse(infos[0].joints_[0].xml_element_.c_str());
  ASSERT_FALSE(again.Error());
  EXPECT_STREQ("j&1", again.RootElement()->Attribute("name"));
}

TEST(TransmissionParser, AppendsToExistingTransmissions) {
  std::vector<TransmissionInfo> infos(1);
  infos[0].name_ = "before";
  ASSERT_TRUE(TransmissionParser::parse(
      robot(transmission(std::string(kGoodJoint) + kGoodActuator)), infos));
  ASSERT_EQ(2u, infos.size());
  EXPECT_EQ("before", infos[0].name_);
  EXPECT_EQ("t", infos[1].name_);
}

TEST(TransmissionParser, SkipsOnlyInvalidTransmissions) {
  const std::string parts = std::string(kGoodJoint) + kGoodActuator;
  const std::string good = transmission(parts);
  const std::vector<std::string> invalid = {
      "<transmission><type>a/T</type>" + parts + "</transmission>",
      "<transmission name=''><type>a/T</type>" + parts + "</transmission>",
      "<transmission name='x'>" + parts + "</transmission>",
      "<transmission name='x'><type/>" + parts + "</transmission>",
      "<transmission name='x'><type></type>" + parts + "</transmission>",
      "<transmission name='x'><type>a/T</type>" + std::string(kGoodActuator) + "</transmission>",
      "<transmission name='x'><type>a/T</type>" + std::string(kGoodJoint) + "</transmission>",
  };
  for (const std::string& bad : invalid) {
    const auto infos = parsed(bad + good);
    ASSERT_EQ(1u, infos.size()) << bad;
    EXPECT_EQ("t", infos[0].name_) << bad;
  }
}

TEST(TransmissionParser, UnnamedPartInvalidatesTheTransmission) {
  EXPECT_THAT(parsed(transmission(std::string(kGoodJoint) + "<joint/>" + kGoodActuator)),
              IsEmpty());
  EXPECT_THAT(parsed(transmission(std::string(kGoodJoint) + kGoodActuator + "<actuator/>")),
              IsEmpty());
}

TEST(TransmissionParser, EmptyNameOrMissingInterfaceInvalidatesOnlyThatPart) {
  const auto infos = parsed(transmission(
      "<joint name=''><hardwareInterface>a/A</hardwareInterface></joint><joint name='j0'/>"
      "<joint name='j00'><hardwareInterface/></joint>" +
      std::string(kGoodJoint) + "<actuator name=''/>" + kGoodActuator));
  ASSERT_EQ(1u, infos.size());
  ASSERT_EQ(1u, infos[0].joints_.size());
  EXPECT_EQ("j1", infos[0].joints_[0].name_);
  ASSERT_EQ(1u, infos[0].actuators_.size());
  EXPECT_EQ("m1", infos[0].actuators_[0].name_);
}
