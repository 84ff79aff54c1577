#include "ground_proof.h"

void GroundProof::begin(uint16_t pulse_v) {
  phase_ = CHARGE;
  phase_ms_ = 0;
  pulse_v_ = pulse_v;
}

GroundProof::Verdict GroundProof::step(const uint16_t measured_v[CHANNELS], bool closed, GroundEvidence evidence[CHANNELS]) {
  const uint16_t enough_v = pulse_v_ / 5 * 4;
  ++phase_ms_;
  switch (phase_) {
    case CHARGE:
      if (measured_v[0] >= enough_v && measured_v[1] >= enough_v) {
        for (uint8_t channel = 0; channel < CHANNELS; ++channel) charged_v_[channel] = kept_v_[channel] = measured_v[channel];
        phase_ = LET_GO;
        phase_ms_ = 0;
      }
      return phase_ms_ > CHARGE_MS ? NOT_CHARGED : RUNNING;
    case LET_GO:
      for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
        if (!closed) kept_v_[channel] = measured_v[channel];
        evidence[channel].leaked(charged_v_[channel], kept_v_[channel]);
      }
      if (closed) {
        phase_ = GROUND;
        phase_ms_ = 0;
      }
      return phase_ms_ > CHARGE_MS ? NOT_GROUNDED : RUNNING;
    default:
      if (evidence[0].proven() && evidence[1].proven()) return PROVEN;
      return phase_ms_ > GROUND_PROOF_MS ? NOT_GROUNDED : RUNNING;
  }
}
