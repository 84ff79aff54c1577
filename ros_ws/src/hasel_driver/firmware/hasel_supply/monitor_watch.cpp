#include "monitor_watch.h"

#include "board.h"

bool MonitorWatch::step(uint16_t asked_v, uint16_t measured_v) {
  if (asked_v >= LEAST_FOLLOWED_V) low_ms_ = measured_v < asked_v / 2 ? low_ms_ + 1 : 0;
  const uint16_t moved_v = measured_v > stuck_v_ ? measured_v - stuck_v_ : stuck_v_ - measured_v;
  if (moved_v > STUCK_V) {
    stuck_v_ = measured_v;
    anchor_v_ = asked_v;
    risen_ms_ = fallen_ms_ = 0;
  }
  const uint16_t followed_v = asked_v - asked_v / 20 * 3;  // a monitor that is out by more is refused by `calibrate`, too
  if (asked_v >= anchor_v_ + MOVED_V && stuck_v_ <= followed_v) ++risen_ms_;
  // Without a break: a converter cannot sink, so a ripple need not be followed.
  fallen_ms_ = asked_v + MOVED_V <= anchor_v_ ? fallen_ms_ + 1 : 0;
  return low_ms_ >= LOW_MS || risen_ms_ >= STUCK_MS || fallen_ms_ >= STUCK_MS;
}
