// The test pulse of every arming: charge both muscles, let go, and see the ground contacts discharge them.
#pragma once

#include <stdint.h>

#include "board.h"
#include "ground_evidence.h"

class GroundProof {
 public:
  enum Verdict : uint8_t { RUNNING, PROVEN, NOT_CHARGED, NOT_GROUNDED };

  void begin(uint16_t pulse_v);
  // One millisecond; `closed`: both ground contacts. The leakage that is seen goes into `evidence`.
  Verdict step(const uint16_t measured_v[CHANNELS], bool closed, GroundEvidence evidence[CHANNELS]);
  int16_t wanted_v() const { return phase_ == CHARGE ? pulse_v_ : 0; }

 private:
  enum Phase : uint8_t { CHARGE, LET_GO, GROUND };

  Phase phase_ = CHARGE;
  uint16_t pulse_v_ = 0;
  uint16_t charged_v_[CHANNELS] = {0}, kept_v_[CHANNELS] = {0};
  uint16_t phase_ms_ = 0;
};
