#include "lobe/device/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lobe/core/error.hpp"
#include "support/device.hpp"
#include "support/environment.hpp"

namespace lobe::test {
namespace {

TEST(ListDevices, FindsAtLeastOneWithDoublePrecision) {
  const auto devices = list_devices();

  EXPECT_THAT(devices, ::testing::Contains(::testing::Field(&DeviceInfo::has_double, true)));
}

TEST(Device, SelectorOfTheListChoosesThatDevice) {
  for (const auto& info : list_devices()) {
    SCOPED_TRACE(info.selector);
    if (!info.has_double) continue;
    EXPECT_EQ(Device::choose(info.selector).info().selector, info.selector);
  }
}

TEST(Device, IsChosenByAPieceOfItsPlatformNameInAnyCase) {
  const auto& info = device().info();
  std::string piece = info.platform.substr(0, 5);
  for (auto& c : piece) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));

  EXPECT_EQ(Device::choose(piece).info().platform, info.platform);
}

TEST(Device, IsChosenByTheEnvironmentWhenNoSelectorIsGiven) {
  const auto selector = device().info().selector;
  const ScopedVariable variable("LOBE_DEVICE", selector);

  EXPECT_EQ(Device::choose().info().selector, selector);
}

TEST(Device, ASelectorThatMatchesNothingIsADeviceErrorThatListsWhatThereIs) {
  try {
    (void)Device::choose("no such platform");
    FAIL() << "expected DeviceError";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("no such platform"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(device().info().platform));
  }
}

TEST(Device, AnEnvironmentThatMatchesNothingIsNamedInTheError) {
  const ScopedVariable variable("LOBE_DEVICE", "no such platform");

  try {
    (void)Device::choose();
    FAIL() << "expected DeviceError";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("LOBE_DEVICE"));
  }
}

TEST(Device, OnDemandIsChosenWhenSomethingAsksForIt) {
  const Device later = Device::on_demand(device().info().selector);

  EXPECT_FALSE(later.is_chosen());
  EXPECT_EQ(later.info().selector, device().info().selector);
  EXPECT_TRUE(later.is_chosen());
  EXPECT_TRUE(device().is_chosen());
}

TEST(Device, OnDemandThatMatchesNothingFailsThen) {
  const Device never = Device::on_demand("no such platform");

  EXPECT_THROW((void)never.info(), DeviceError);
  EXPECT_FALSE(never.is_chosen());
}

TEST(Device, APackWidthThatDoesNotExistIsAnArgumentError) {
  const ScopedVariable variable("LOBE_PACK", "3");

  EXPECT_THROW((void)Device::choose(), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
