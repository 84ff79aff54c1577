#include "calibration.h"

#include <avr/eeprom.h>
#include <string.h>
#include <util/crc16.h>

namespace {

struct Stored {
  Calibration calibrations[2];
  uint16_t checksum;
};

uint16_t checksum(const Stored& stored) {
  uint16_t crc = 0xFFFF;  // so that an EEPROM full of zeros does not fit
  const uint8_t* bytes = reinterpret_cast<const uint8_t*>(stored.calibrations);
  for (uint8_t i = 0; i < sizeof(stored.calibrations); ++i) crc = _crc_xmodem_update(crc, bytes[i]);
  return crc;
}

bool never_stored(const Stored& stored) {
  const uint8_t* bytes = reinterpret_cast<const uint8_t*>(&stored);
  for (uint8_t i = 0; i < sizeof(stored); ++i) {
    if (bytes[i] != 0xFF) return false;
  }
  return true;
}

}  // namespace

uint16_t Calibration::monitored(uint16_t volts) const {
  const int32_t value = ((int32_t)volts - read_offset_v) * UNITY / read_gain;
  return value < 0 ? 0 : value;
}

bool load_calibrations(Calibration calibrations[2]) {
  Stored stored;
  eeprom_read_block(&stored, nullptr, sizeof(stored));
  if (stored.checksum != checksum(stored)) return never_stored(stored);
  memcpy(static_cast<void*>(calibrations), stored.calibrations, sizeof(stored.calibrations));
  return true;
}

void store_calibrations(const Calibration calibrations[2]) {
  Stored stored;
  memcpy(static_cast<void*>(stored.calibrations), calibrations, sizeof(stored.calibrations));
  stored.checksum = checksum(stored);
  eeprom_update_block(&stored, nullptr, sizeof(stored));
}
