// What the command reports about the devices that are plugged in.

#include "palpate/devices/device_access.h"

#include <gtest/gtest.h>

#include "palpate/devices/falcon.h"
#include "palpate/devices/usb_devices.h"

namespace palpate::devices {
namespace {

TEST(UdevRule, NamesTheDeviceAndPermitsItToTheGroup) {
  EXPECT_EQ(udevRule(kFalconVendor, kFalconProduct),
            "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\", "
            "MODE=\"0660\", GROUP=\"plugdev\", TAG+=\"uaccess\"");
}

TEST(UsbDevices, AreListedWhateverIsPluggedIn) {
  for (const UsbDevice& each : listUsbDevices()) {
    EXPECT_GT(each.bus, 0);
    EXPECT_GT(each.address, 0);
    EXPECT_TRUE(each.is_accessible || each.serial.empty());
  }
}

}  // namespace
}  // namespace palpate::devices
