#include "ground_evidence.h"

#include "board.h"

void GroundEvidence::leaked(uint16_t charged_v, uint16_t kept_v) {
  charged_v_ = max(charged_v, (uint16_t)1);
  kept_v_ = min(kept_v, charged_v_);
}

void GroundEvidence::step(bool closed, uint16_t measured_v, uint16_t least_v) {
  if (!closed) {
    proven_ = falling_ = was_closed_ = false;
    return;
  }
  if (!was_closed_) {
    was_closed_ = true;
    falling_ = measured_v >= least_v;
    below_v_ = min(DISCHARGED_V, (uint16_t)(measured_v / 5 * 2));
    leaked_v_ = measured_v;
    falling_ms_ = 0;
    forecast();
  }
  if (!falling_) return;
  if (measured_v < below_v_ && measured_v <= leaked_v_ / 2) {
    proven_ = true;
    falling_ = false;
  } else if (++falling_ms_ >= GROUND_PROOF_MS || leaked_v_ < LEAST_FORECAST_V) {
    falling_ = false;
  } else if (++forecast_ms_ >= LEAK_MS) {
    forecast();
  }
}

void GroundEvidence::forecast() {
  leaked_v_ = (uint32_t)leaked_v_ * kept_v_ / charged_v_;
  forecast_ms_ = 0;
}
