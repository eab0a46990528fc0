// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <hardware_interface/internal/hardware_resource_manager.h>
#include <hardware_interface/internal/interface_manager.h>

#include <memory>
#include <string>

using namespace hardware_interface;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

/// A handle with only a name and an origin.
struct Tag {
  Tag() = default;
  Tag(std::string tag_name, int tag_origin) : name(std::move(tag_name)), origin(tag_origin) {}
  std::string getName() const { return name; }
  std::string name;
  int origin{0};
};

struct Plain {
  int value{0};
};

int living_interfaces = 0;

struct Tags : HardwareResourceManager<Tag, ClaimResources> {
  Tags() { ++living_interfaces; }
  ~Tags() override { --living_interfaces; }
};

std::unique_ptr<Tags> tags(const std::string& first, const std::string& second, int origin) {
  auto made = std::make_unique<Tags>();
  made->registerHandle(Tag(first, origin));
  made->registerHandle(Tag(second, origin));
  return made;
}

const std::string kTags = internal::demangledTypeName<Tags>();
const std::string kPlain = internal::demangledTypeName<Plain>();

}  // namespace

TEST(InterfaceManager, FindsOnlyRegisteredInterfaces) {
  InterfaceManager manager;
  Plain plain;
  manager.registerInterface(&plain);
  EXPECT_EQ(&plain, manager.get<Plain>());
  EXPECT_EQ(nullptr, manager.get<Tags>());
  EXPECT_THAT(manager.getNames(), ElementsAre(kPlain));
  EXPECT_THAT(manager.getInterfaceResources(kPlain), IsEmpty());
  EXPECT_THAT(manager.getInterfaceResources("unheard::Of"), IsEmpty());
}

TEST(InterfaceManager, SecondInterfaceOfATypeReplacesTheFirst) {
  InterfaceManager manager;
  Plain first, second;
  manager.registerInterface(&first);
  manager.registerInterface(&second);
  EXPECT_EQ(&second, manager.get<Plain>());
}

TEST(InterfaceManager, ListsResourcesAsOfRegistration) {
  InterfaceManager manager;
  const auto registered = tags("b", "a", 1);
  manager.registerInterface(registered.get());
  registered->registerHandle(Tag("later", 1));
  EXPECT_THAT(manager.getInterfaceResources(kTags), ElementsAre("a", "b"));
  manager.registerInterface(registered.get());
  EXPECT_THAT(manager.getInterfaceResources(kTags), ElementsAre("a", "b", "later"));
}

TEST(InterfaceManager, FindsInterfacesOfChildrenAndGrandchildren) {
  InterfaceManager manager, child, grandchild;
  Plain plain;
  grandchild.registerInterface(&plain);
  child.registerInterfaceManager(&grandchild);
  manager.registerInterfaceManager(&child);
  EXPECT_EQ(&plain, manager.get<Plain>());
  EXPECT_THAT(manager.getNames(), ElementsAre(kPlain));
}

TEST(InterfaceManager, CombinesInterfacesOfSeveralManagers) {
  InterfaceManager manager, left, right;
  const auto left_tags = tags("left_1", "shared", 1);
  const auto right_tags = tags("right_1", "shared", 2);
  left.registerInterface(left_tags.get());
  right.registerInterface(right_tags.get());
  manager.registerInterfaceManager(&left);
  manager.registerInterfaceManager(&right);

  Tags* combined = manager.get<Tags>();
  ASSERT_NE(nullptr, combined);
  EXPECT_NE(left_tags.get(), combined);
  EXPECT_NE(right_tags.get(), combined);
  EXPECT_EQ(combined, manager.get<Tags>()) << "the same object as long as nothing changes";
  EXPECT_EQ(left_tags.get(), left.get<Tags>()) << "a child still answers with its own";
  EXPECT_THAT(combined->getNames(), ElementsAre("left_1", "right_1", "shared"));
  EXPECT_EQ(1, combined->getHandle("left_1").origin);
  EXPECT_EQ(2, combined->getHandle("shared").origin) << "copied in order, so the last one wins";
  EXPECT_THAT(combined->getClaims(), ElementsAre("left_1", "shared"));
  EXPECT_THAT(left_tags->getClaims(), IsEmpty());
  EXPECT_THAT(manager.getNames(), ElementsAre(kTags)) << "no type is listed twice";
  EXPECT_THAT(manager.getInterfaceResources(kTags),
              ElementsAre("left_1", "shared", "right_1", "shared"));
}

TEST(InterfaceManager, CombinesAgainWhenTheirNumberChanges) {
  InterfaceManager manager, child;
  const auto own = tags("a", "b", 1);
  const auto second = tags("c", "d", 2);
  const auto third = tags("e", "f", 3);
  manager.registerInterface(own.get());
  child.registerInterface(second.get());
  manager.registerInterfaceManager(&child);
  Tags* before = manager.get<Tags>();
  ASSERT_NE(nullptr, before);

  InterfaceManager late;
  late.registerInterface(third.get());
  manager.registerInterfaceManager(&late);
  Tags* after = manager.get<Tags>();
  ASSERT_NE(nullptr, after);
  EXPECT_NE(before, after);
  EXPECT_THAT(after->getNames(), ElementsAre("a", "b", "c", "d", "e", "f"));
  EXPECT_THAT(before->getNames(), ElementsAre("a", "b", "c", "d")) << "old pointers stay valid";
}

TEST(InterfaceManager, OwnsTheCombinedInterfaces) {
  const auto first = tags("a", "b", 1);
  const auto second = tags("c", "d", 2);
  {
    InterfaceManager manager, child;
    manager.registerInterface(first.get());
    child.registerInterface(second.get());
    manager.registerInterfaceManager(&child);
    ASSERT_NE(nullptr, manager.get<Tags>());
    EXPECT_EQ(3, living_interfaces);
  }
  EXPECT_EQ(2, living_interfaces);
}

TEST(InterfaceManager, CombinesOnlyResourceManagers) {
  InterfaceManager manager, child;
  Plain first, second;
  manager.registerInterface(&first);
  child.registerInterface(&second);
  manager.registerInterfaceManager(&child);
  EXPECT_EQ(nullptr, manager.get<Plain>());
}
