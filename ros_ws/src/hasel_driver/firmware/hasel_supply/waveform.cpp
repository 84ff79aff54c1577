#include "waveform.h"

#include <avr/pgmspace.h>

const char* const SHAPE_NAMES[] = {"box", "ramp", "sine", "triangle"};
const char* const POLARITY_NAMES[] = {"positive", "negative", "alternating"};
const char* const MUSCLE_NAMES[] = {"both", "upper", "lower", "lower_first"};

namespace {

constexpr uint32_t HALF_PERIOD = 0x80000000UL;

// sin(pi i / 32) * 65535
const uint16_t HALF_WAVE[33] PROGMEM = {
    0,     6423,  12785, 19024, 25079, 30893, 36409, 41575, 46340, 50659, 54490, 57797, 60546, 62713, 64276, 65219, 65535,
    65219, 64276, 62713, 60546, 57797, 54490, 50659, 46340, 41575, 36409, 30893, 25079, 19024, 12785, 6423,  0};

}  // namespace

void WaveformGenerator::start(const Waveform& waveform) {
  waveform_ = waveform;
  phase_ = 0;
  cycle_ = 0;
  increment_ = ((uint64_t)waveform.frequency_mhz << 32) / 1000000UL;
  driven_ = (uint64_t)HALF_PERIOD * waveform.duty / 1000;
}

bool WaveformGenerator::next(int16_t voltage_v[2]) {
  voltage_v[0] = voltage_v[1] = 0;
  if (cycle_ >= waveform_.periods) return false;
  if (waveform_.muscles != Waveform::LOWER) {
    voltage_v[0] = muscle_voltage(waveform_.muscles == Waveform::LOWER_FIRST);
  }
  if (waveform_.muscles != Waveform::UPPER) {
    voltage_v[1] = muscle_voltage(waveform_.muscles == Waveform::BOTH);
  }
  const uint32_t before = phase_;
  phase_ += increment_;
  if (phase_ < before) ++cycle_;
  return true;
}

int16_t WaveformGenerator::muscle_voltage(bool delayed) const {
  uint32_t position = phase_;
  uint16_t drive = cycle_;
  if (delayed) {
    if (phase_ < HALF_PERIOD) return 0;  // its drive, the second half of a period, has not begun
    position -= HALF_PERIOD;
  }
  if (position >= driven_) return 0;
  const uint16_t share = ((position >> 15) << 16) / ((driven_ >> 15) + 1);
  int16_t voltage = (waveform_.voltage_v * shape_at(share)) >> 16;
  if (waveform_.shape == Waveform::BOX) voltage = waveform_.voltage_v;
  const bool negative =
      waveform_.polarity == Waveform::NEGATIVE_ONLY || (waveform_.polarity == Waveform::ALTERNATING && (drive & 1));
  return negative ? -voltage : voltage;
}

int32_t WaveformGenerator::shape_at(uint16_t position) const {
  switch (waveform_.shape) {
    case Waveform::RAMP:
      return position;
    case Waveform::TRIANGLE:
      return position < 0x8000 ? 2L * position : 2L * (0xFFFF - position);
    case Waveform::SINE: {
      const uint8_t index = position >> 11;
      const int32_t left = pgm_read_word(&HALF_WAVE[index]);
      const int32_t right = pgm_read_word(&HALF_WAVE[index + 1]);
      return left + (((right - left) * (position & 0x7FF)) >> 11);
    }
    default:
      return 0xFFFF;
  }
}
