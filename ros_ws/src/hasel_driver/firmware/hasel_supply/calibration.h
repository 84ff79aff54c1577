// Corrections of one channel's converter and voltage monitor, kept in the EEPROM.
#pragma once

#include <stdint.h>

struct Calibration {
  static constexpr int16_t UNITY = 10000;

  int16_t set_gain = UNITY;   // 1/10000
  int16_t set_offset_v = 0;
  int16_t read_gain = UNITY;  // 1/10000
  int16_t read_offset_v = 0;

  // What to ask of the converter for `volts`, and what the muscle has when the monitor says `volts`; never negative.
  uint16_t set_point(uint16_t volts) const { return corrected(volts, set_gain, set_offset_v); }
  uint16_t measured(uint16_t volts) const { return corrected(volts, read_gain, read_offset_v); }
  // What the monitor says at a true voltage: the inverse of measured().
  uint16_t monitored(uint16_t volts) const;

 private:
  static uint16_t corrected(uint16_t volts, int16_t gain, int16_t offset_v) {
    const int32_t value = (int32_t)volts * gain / UNITY + offset_v;
    return value < 0 ? 0 : value;
  }
};

// Both channels; what was never stored is no correction. False: what is stored does not fit its checksum.
bool load_calibrations(Calibration calibrations[2]);
void store_calibrations(const Calibration calibrations[2]);
