// What proves one channel's ground contact: its muscle's voltage fell faster than leakage alone would have let it.
#pragma once

#include <stdint.h>

class GroundEvidence {
 public:
  // With nothing connected, `charged_v` became `kept_v` within LEAK_MS.
  void leaked(uint16_t charged_v, uint16_t kept_v);
  // One millisecond; a fall counts if it begins at `least_v` or more as the contact closes.
  void step(bool closed, uint16_t measured_v, uint16_t least_v);
  bool proven() const { return proven_; }

 private:
  void forecast();

  uint16_t charged_v_ = 1, kept_v_ = 1;
  uint16_t below_v_ = 0, leaked_v_ = 0;  // that the fall must reach; that leakage alone would leave
  uint8_t falling_ms_ = 0, forecast_ms_ = 0;
  bool proven_ = false, falling_ = false, was_closed_ = true;
};
