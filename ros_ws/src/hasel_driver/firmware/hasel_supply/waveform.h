// Box, ramp, sine and triangle drives of two antagonistic muscles, one value per millisecond.
#pragma once

#include <stdint.h>

struct Waveform {
  enum Shape : uint8_t { BOX, RAMP, SINE, TRIANGLE, SHAPES };
  enum Polarity : uint8_t { POSITIVE_ONLY, NEGATIVE_ONLY, ALTERNATING, POLARITIES };
  enum Muscles : uint8_t { BOTH, UPPER, LOWER, LOWER_FIRST, MUSCLE_ORDERS };

  Shape shape = BOX;
  int16_t voltage_v = 0;
  uint16_t frequency_mhz = 1000;
  uint16_t periods = 1;
  uint16_t duty = 1000;  // per mille of the half period
  Polarity polarity = POSITIVE_ONLY;
  Muscles muscles = BOTH;
};

extern const char* const SHAPE_NAMES[Waveform::SHAPES];
extern const char* const POLARITY_NAMES[Waveform::POLARITIES];
extern const char* const MUSCLE_NAMES[Waveform::MUSCLE_ORDERS];

class WaveformGenerator {
 public:
  void start(const Waveform& waveform);
  // False once the waveform has ended; the voltages are those of the present millisecond.
  bool next(int16_t voltage_v[2]);

 private:
  int16_t muscle_voltage(bool delayed) const;
  int32_t shape_at(uint16_t position) const;

  Waveform waveform_;
  uint32_t phase_ = 0;  // 2^32 is one period
  uint32_t increment_ = 0;
  uint32_t driven_ = 0;  // length of one drive, as a phase
  uint16_t cycle_ = 0;
};
