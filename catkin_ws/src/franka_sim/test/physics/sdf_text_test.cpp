// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// How SDF texts become scenes.
#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "physics/sdf/sdf_scene.h"
#include "sdf_test.h"

namespace franka_sim::test {
namespace {

using physics::SdfJoint;
using physics::SdfScene;

const char* const kInertial =
    "<inertial><pose>0.01 -0.02 0.03 0.4 0.5 0.6</pose><mass>3.5</mass><inertia><ixx>0.05</ixx>"
    "<iyy>0.04</iyy><izz>0.03</izz><ixy>0.001</ixy><ixz>-0.002</ixz><iyz>0.0015</iyz></inertia>"
    "</inertial>";

Eigen::Isometry3d poseFrom(double x, double y, double z, double roll, double pitch, double yaw) {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

void expectNear(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const std::string& what) {
  EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), 1e-12) << what;
}

class SdfTextTest : public SdfTest {
 protected:
  SdfScene read(const std::string& text) const {
    return physics::readSdf(text, folder_.path(), "test", {});
  }

  static std::string world(const std::string& content, const std::string& version) {
    return "<sdf version='" + version + "'><world name='w'>" + content + "</world></sdf>";
  }
};

TEST_F(SdfTextTest, PosesFollowTheirFrames) {
  const SdfScene scene = read(
      world("<frame name='corner'><pose>1 2 0 0 0 0.5</pose></frame>"
            "<model name='m' placement_frame='grip'><pose relative_to='corner'>0 0 1 0.1 0 0</pose>"
            "<frame name='grip' attached_to='a'><pose>0 0 0.2 0 0.3 0</pose></frame>"
            "<link name='a'><pose>0.5 0 0 0 0 0.7</pose>" +
                std::string(kInertial) +
                "<visual name='v'><pose relative_to='grip'>0 0.1 0 0 0 0</pose>"
                "<geometry><sphere><radius>0.1</radius></sphere></geometry></visual></link>"
                "<link name='b'><pose relative_to='j'>0 0 0.1 0 0 0</pose></link>"
                "<joint name='j' type='revolute'><pose relative_to='a'>0 0.1 0 0.2 0 0</pose>"
                "<parent>a</parent><child>b</child><axis><xyz expressed_in='grip'>1 1 0</xyz>"
                "<limit><lower>-1</lower><upper>inf</upper></limit></axis></joint></model>",
            "1.7"));
  const Eigen::Isometry3d a = poseFrom(0.5, 0, 0, 0, 0, 0.7);
  const Eigen::Isometry3d grip = a * poseFrom(0, 0, 0.2, 0, 0.3, 0);
  const Eigen::Isometry3d m =
      poseFrom(1, 2, 0, 0, 0, 0.5) * poseFrom(0, 0, 1, 0.1, 0, 0) * grip.inverse();
  const Eigen::Isometry3d j = a * poseFrom(0, 0.1, 0, 0.2, 0, 0);
  ASSERT_EQ(scene.links.size(), 2u);
  expectNear(scene.links[0].pose, m * a, "a");
  expectNear(scene.links[1].pose, m * j * poseFrom(0, 0, 0.1, 0, 0, 0), "b");
  expectNear(scene.links[0].visuals[0].pose, a.inverse() * grip * poseFrom(0, 0.1, 0, 0, 0, 0),
             "visual");
  const Eigen::Vector3d axis = m.linear() * grip.linear() * Eigen::Vector3d(1, 1, 0).normalized();
  EXPECT_LT((scene.joints[0].axis - axis).norm(), 1e-12);
  EXPECT_LT((scene.joints[0].position - (m * j).translation()).norm(), 1e-12);
  ASSERT_TRUE(scene.joints[0].limits.has_value());
  EXPECT_EQ((*scene.joints[0].limits)[0], -1);
}

/// Before SDF 1.7 axes are in the joint's frame; a version decides whether in the model's.
TEST_F(SdfTextTest, OldAxesUseTheFrameOfTheirVersion) {
  const auto text = [](const std::string& in_axis) {
    return "<model name='m'><pose>0 0 0 0.3 0 0</pose><link name='a'/><link name='b'><pose>0 0 1 0 "
           "0.4 0</pose></link><joint name='j' type='prismatic'><parent>a</parent><child>b</child>"
           "<axis><xyz>1 0 0</xyz>" +
           in_axis + "<limit><lower>0</lower><upper>1</upper></limit></axis></joint></model>";
  };
  const Eigen::Matrix3d model = poseFrom(0, 0, 0, 0.3, 0, 0).linear();
  const Eigen::Vector3d of_model = model * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d of_joint =
      model * poseFrom(0, 0, 0, 0, 0.4, 0).linear() * Eigen::Vector3d::UnitX();
  const auto axis = [&](const std::string& in_axis, const std::string& version) {
    return read(world(text(in_axis), version)).joints.at(0).axis;
  };
  EXPECT_LT((axis("", "1.4") - of_model).norm(), 1e-12);
  EXPECT_LT((axis("", "1.6") - of_joint).norm(), 1e-12);
  EXPECT_LT((axis("", "1.11") - of_joint).norm(), 1e-12);
  const std::string old_way = "<use_parent_model_frame>true</use_parent_model_frame>";
  EXPECT_LT((axis(old_way, "1.6") - of_model).norm(), 1e-12);
}

TEST_F(SdfTextTest, ExpandsNestedModelsAndIncludes) {
  write("crate/model.config",
        "<model><name>crate</name><sdf version='1.4'>old.sdf</sdf>"
        "<sdf version='1.6'>model.sdf</sdf></model>");
  write("crate/model.sdf",
        "<sdf version='1.6'><model name='crate'><link name='link'>" + std::string(kInertial) +
            "<collision name='c'><geometry><mesh><uri>meshes/tetra.obj</uri></mesh></geometry>"
            "</collision><collision name='d'><geometry><mesh><uri>model://crate/meshes/tetra.obj"
            "</uri><scale>2 2 2</scale></mesh></geometry></collision></link></model></sdf>");
  write("crate/meshes/tetra.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\n");
  const SdfScene scene = read(
      world("<include><uri>model://sun</uri></include>"
            "<include><uri>model://ground_plane</uri></include>"
            "<include><uri>model://crate</uri><name>first</name><pose>0 0 1 0 0 0</pose>"
            "<static>true</static></include>"
            "<model name='outer'><static>true</static><pose>1 0 0 0 0 1</pose><link name='plate'/>"
            "<model name='inner'><pose>0 1 0 0 0 0</pose><link name='l'/></model>"
            "<joint name='hold' type='fixed'><parent>plate</parent><child>inner::l</child></joint>"
            "</model>",
            "1.8"));
  ASSERT_EQ(scene.models.size(), 3u);
  EXPECT_EQ(scene.links[1].name, "first::link");
  EXPECT_TRUE(scene.links[1].is_static);
  for (const auto& collision : scene.links[1].collisions) {
    EXPECT_TRUE(
        std::filesystem::equivalent(collision.mesh.file, folder_ / "crate/meshes/tetra.obj"))
        << collision.mesh.file;
  }
  EXPECT_EQ(scene.links[1].collisions.size(), 2u);
  EXPECT_EQ(scene.links[3].name, "outer::inner::l");
  expectNear(scene.links[3].pose, poseFrom(1, 0, 0, 0, 0, 1) * poseFrom(0, 1, 0, 0, 0, 0), "l");
  EXPECT_EQ(scene.joints.at(0).child, 3);
}

TEST_F(SdfTextTest, MergesIncludedModels) {
  write("arm/model.sdf",
        "<sdf version='1.9'><model name='arm'><frame name='tip'><pose>0 0 0.2 0 0.4 0</pose>"
        "</frame><link name='base'/><link name='fore'><pose relative_to='tip'>0.3 0 0 0 0 0</pose>"
        "</link><joint name='hinge' type='revolute'><parent>base</parent><child>fore</child><axis>"
        "<xyz expressed_in='__model__'>0 0 1</xyz></axis></joint></model></sdf>");
  const auto text = [](const std::string& more) {
    return world(
        "<model name='m'><pose>0 0 1 0.2 0 0</pose><include merge='true'><uri>model://arm</uri>"
        "<pose>1 2 0 0 0.5 0</pose></include>" +
            more + "</model>",
        "1.9");
  };
  const SdfScene scene =
      read(text("<link name='tool'><pose relative_to='fore'>0 0 0.1 0 0 0</pose></link>"
                "<joint name='j' type='fixed'><parent>fore</parent><child>tool</child></joint>"));
  EXPECT_TRUE(scene.unsupported.empty());
  ASSERT_EQ(scene.links.size(), 3u);
  const Eigen::Isometry3d arm = poseFrom(0, 0, 1, 0.2, 0, 0) * poseFrom(1, 2, 0, 0, 0.5, 0);
  const Eigen::Isometry3d fore =
      arm * poseFrom(0, 0, 0.2, 0, 0.4, 0) * poseFrom(0.3, 0, 0, 0, 0, 0);
  for (const auto& link : scene.links) {
    expectNear(link.pose,
               link.name == "m::base"   ? arm
               : link.name == "m::fore" ? fore
                                        : fore * poseFrom(0, 0, 0.1, 0, 0, 0),
               link.name);
  }
  EXPECT_EQ(scene.joints.at(0).name, "m::hinge");
  EXPECT_LT((scene.joints.at(0).axis - arm.linear().col(2)).norm(), 1e-12);
  const SdfJoint& fixed = scene.joints.at(1);
  EXPECT_EQ(scene.links.at(fixed.parent).name, "m::fore");
  EXPECT_EQ(scene.links.at(fixed.child).name, "m::tool");
  expectSentence([&] { read(text("<link name='base'/>")); }, {"'m::base'", "merging"});
}

/// Gazebo 11 writes models of models in this way.
TEST_F(SdfTextTest, ReadsFlattenedNames) {
  const SdfScene scene =
      read(world("<model name='o'><link name='p'/><frame name='i::__model__' attached_to='i::l'>"
                 "<pose relative_to='__model__'>0 1 0 0 0 0</pose></frame><link name='i::l'>"
                 "<pose relative_to='i::__model__'>0 0 1 0 0 0</pose></link></model>",
                 "1.7"));
  EXPECT_EQ(scene.links.at(1).name, "o::i::l");
  expectNear(scene.links.at(1).pose, poseFrom(0, 1, 1, 0, 0, 0), "i::l");
}

TEST_F(SdfTextTest, GravityBelongsToThePhysicsBeforeVersionSix) {
  const std::string text = "<physics type='ode'><gravity>0 0 -1.5</gravity></physics>";
  const SdfScene old = read(world(text, "1.5")), later = read(world(text, "1.6"));
  EXPECT_EQ(old.gravity[2], -1.5);
  EXPECT_TRUE(old.unsupported.empty());
  EXPECT_EQ(later.gravity[2], -9.8);
  EXPECT_EQ(later.unsupported.count("<gravity> of <physics>"), 1u);
}

TEST_F(SdfTextTest, NamesWhatItDoesNotRead) {
  write("cup.urdf", "<robot name='cup'><link name='l'/></robot>");
  const SdfScene scene = read(world(
      "<gui><camera name='c'/></gui><physics type='ode'/><gz:policies/><state world_name='w'/>"
      "<include><uri>cup.urdf</uri></include>"
      "<model name='m'><allow_auto_disable>1</allow_auto_disable><drone/><link name='l'>"
      "<kinematic> true </kinematic><velocity_decay><linear>0.1</linear><angular>0</angular>"
      "</velocity_decay><inertial auto='true'><density>7</density></inertial><battery/>"
      "<collision name='c'><geometry><sphere/></geometry><max_contacts>9</max_contacts>"
      "<surface><soft_contact/></surface></collision><visual name='v'><geometry><sphere/>"
      "</geometry><meta/><plugin name='p'/></visual></link><link name='k'/>"
      "<joint name='j' type='revolute'><parent>l</parent><child>k</child>"
      "<axis><xyz>0 0 1</xyz><mimic joint='i'/><initial_position>1</initial_position></axis>"
      "<sensor name='s' type='force_torque'/></joint></model>",
      "1.11"));
  EXPECT_EQ(scene.unsupported,
            (std::set<std::string>{
                "<state> of the world",
                "the <include> of 'cup.urdf' (" + (folder_ / "cup.urdf") + " is a URDF)",
                "<drone> of model 'm'", "<kinematic> of link 'm::l'",
                "<linear> in <velocity_decay> of link 'm::l'", "<battery> of link 'm::l'",
                "the automatic inertia of link 'm::l'", "<density> of the inertia of link 'm::l'",
                "<soft_contact> of collision 'c' of 'm::l'", "<plugin> of visual 'v' of 'm::l'",
                "<sensor> of joint 'm::j'", "<mimic> of the axis of joint 'm::j'",
                "<initial_position> in <axis> of joint 'm::j'"}));
}

TEST_F(SdfTextTest, LightsCamerasAndColorsKeepTheirDefaults) {
  const SdfScene scene = read(
      world("<gravity>0 0 -1.62</gravity><scene><ambient>0.1 0.2 0.3 1</ambient>"
            "<background>0.5 0.6 0.7</background></scene>"
            "<light name='lamp' type='spot'><pose>0 0 2 0 0.1 0</pose><direction>0 0 -2</direction>"
            "<attenuation><range>10</range><constant>0.5</constant></attenuation><spot>"
            "<inner_angle>0.1</inner_angle><outer_angle>0.8</outer_angle><falloff>1</falloff>"
            "</spot></light>"
            "<model name='m'><link name='l'><gravity>false</gravity>"
            "<sensor name='eye' type='camera'><pose>0 0 0.1 0 0.2 0</pose><camera><image>"
            "<width>64</width></image></camera></sensor>"
            "<visual name='v'><transparency>0.25</transparency><geometry><cylinder>"
            "<radius>0.1</radius><length>0.5</length></cylinder></geometry><material><script>"
            "<uri>file://media</uri><name>Gazebo/Red</name></script></material></visual>"
            "</link></model>",
            "1.6"));
  EXPECT_EQ(scene.gravity[2], -1.62);
  EXPECT_EQ(scene.lights.at(0).attenuation[0], 0.5);
  EXPECT_EQ(scene.lights.at(0).cutoff, 0.4);
  EXPECT_EQ(scene.cameras.at(0).width, 64);
  EXPECT_EQ(scene.cameras.at(0).height, 240);
  EXPECT_EQ(scene.links.at(0).visuals.at(0).opacity, 0.75);
}

TEST_F(SdfTextTest, BitmasksAreWholeNumbers) {
  const auto collision = [](const std::string& mask) {
    return world(
        "<model name='m'><link name='a'><collision name='c'><geometry><sphere/></geometry>"
        "<surface><contact><collide_bitmask>" +
            mask + "</collide_bitmask></contact></surface></collision></link></model>",
        "1.6");
  };
  for (const auto& [text, mask] :
       {std::pair{"0", 0}, std::pair{"6", 6}, std::pair{"65535", 65535}, std::pair{"0x0a", 10},
        std::pair{"0xffffffff", 65535}, std::pair{"4294967295", 65535}}) {
    EXPECT_EQ(mask, read(collision(text)).links.at(0).collisions.at(0).surface.bitmask) << text;
  }
  for (const char* text : {"-1", "1.5", "1e20", "nan", "0x", "0x1g", "0xfffffffffffffffff"}) {
    expectSentence([&] { read(collision(text)); }, {"collide_bitmask", text});
  }
}

TEST_F(SdfTextTest, RefusesInvalidTexts) {
  const auto refuses = [&](const std::string& text, std::initializer_list<const char*> parts) {
    expectSentence([&] { read(text); }, parts);
  };
  refuses("<sdf version='1.6'><world name='w'>", {"well-formed"});
  refuses("<sdf><world name='w'/></sdf>", {"version"});
  refuses("<sdf version='new'><world name='w'/></sdf>", {"'new'"});
  refuses("<sdf version='1.0'><world name='w'/></sdf>", {"'1.0'", "1.2 or newer"});
  refuses("<sdf version='1.6'><html/></sdf>", {"<world>", "0"});
  refuses(world("<gravity>0 0 down</gravity>", "1.6"), {"<gravity>", "'down'"});
  refuses(world("<model name='m'><static>maybe</static><link name='a'/></model>", "1.6"),
          {"<static>", "'maybe'"});
  refuses(world("<include><uri>model://nowhere</uri></include>", "1.6"), {"nowhere"});
  refuses(world("<model name='m'/>", "1.6"), {"'m'", "link"});
  refuses(world("<model name='m'><link name='a'/><link name='a'/></model>", "1.6"), {"'a'"});
  refuses(world("<model name='m'><link name='a'><inertial><mass>-1</mass></inertial></link>"
                "</model>",
                "1.6"),
          {"'m::a'", "mass"});
  refuses(world("<model name='m'><link name='a'/><joint name='j' type='fixed'><parent>a</parent>"
                "<child>b</child></joint></model>",
                "1.6"),
          {"'m::j'", "'b'"});
  refuses(world("<model name='m'><link name='a'><pose relative_to='b'>0 0 0 0 0 0</pose></link>"
                "<frame name='b' attached_to='a'/></model>",
                "1.7"),
          {"circle"});
  refuses(world("<model name='m'><link name='a'><pose>0 0 nan 0 0 0</pose></link></model>", "1.6"),
          {"'a'", "nan"});
  refuses(world("<model name='m'><link name='a'><pose>0 0 0</pose></link></model>", "1.6"),
          {"'a'", "6 numbers"});
  for (const char* edge : {"width", "height"}) {
    for (const char* pixels : {"0", "-1", "0.5", "1e+20", "nan"}) {
      refuses(world("<model name='m'><link name='a'><sensor name='eye' type='camera'><camera>"
                    "<image><" +
                        std::string(edge) + ">" + pixels + "</" + edge +
                        "></image></camera></sensor></link></model>",
                    "1.6"),
              {"eye", edge, pixels});
    }
  }
  write("loop/model.sdf",
        "<sdf version='1.6'><model name='loop'><include><uri>model://loop</uri></include></model>"
        "</sdf>");
  refuses(world("<include><uri>model://loop</uri></include>", "1.6"), {"without end"});
}

}  // namespace
}  // namespace franka_sim::test
