// Whether one channel's measured voltage follows what its converter is asked for.
#pragma once

#include <stdint.h>

class MonitorWatch {
 public:
  void begin() { *this = MonitorWatch(); }
  // One millisecond with the source connected; true: it has not followed for too long.
  bool step(uint16_t asked_v, uint16_t measured_v);

 private:
  uint16_t low_ms_ = 0, risen_ms_ = 0, fallen_ms_ = 0;
  uint16_t stuck_v_ = 0, anchor_v_ = 0;  // measured, and asked for, when the measured voltage moved last
};
