#include "monitor_watch.h"

#include "board.h"

bool MonitorWatch::step(uint16_t asked_v, uint16_t measured_v) {
  if (asked_v >= LEAST_FOLLOWED_V) low_ms_ = measured_v < asked_v / 2 ? low_ms_ + 1 : 0;
  const uint16_t moved_v = measured_v > stuck_v_ ? measured_v - stuck_v_ : stuck_v_ - measured_v;
  if (moved_v > STUCK_V) {
    stuck_v_ = measured_v;
    least_asked_v_ = most_asked_v_ = asked_v;
    stuck_ms_ = 0;
  }
  least_asked_v_ = min(least_asked_v_, asked_v);
  most_asked_v_ = max(most_asked_v_, asked_v);
  if (most_asked_v_ - least_asked_v_ >= MOVED_V) ++stuck_ms_;
  return low_ms_ >= LOW_MS || stuck_ms_ >= STUCK_MS;
}
