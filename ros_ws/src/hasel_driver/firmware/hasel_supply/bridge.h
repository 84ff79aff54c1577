// Output stage of one channel: polarity contacts with break before make, and the slew limit.
#pragma once

#include <stdint.h>

#include "calibration.h"

class Bridge {
 public:
  enum Contact : uint8_t { GROUND, OPEN, POSITIVE, NEGATIVE };

  void begin(uint8_t channel);
  // Cut the set point and open the source at once; the ground contact follows after the dead time.
  void release();
  // One millisecond towards `wanted_v`, the set point moving by at most `slew_v`.
  void step(int16_t wanted_v, uint16_t slew_v, bool discharged, uint8_t dead_time_ms);
  void calibrate(const Calibration& calibration) { calibration_ = calibration; }

  bool grounded() const { return contact_ == GROUND; }
  bool sourcing() const { return contact_ == POSITIVE || contact_ == NEGATIVE; }
  uint16_t set_point_v() const { return set_point_v_; }
  int8_t sign() const { return sign_; }  // of the source that is or was last connected

 private:
  void move(Contact contact);
  void set_point(uint16_t volts);

  uint8_t channel_ = 0;
  Contact contact_ = GROUND;
  Contact opened_from_ = GROUND;
  uint8_t dwell_ms_ = 0;  // ticks in the present contact, the first of which may be cut short
  uint16_t set_point_v_ = 0;
  int8_t sign_ = 1;
  Calibration calibration_;
};
