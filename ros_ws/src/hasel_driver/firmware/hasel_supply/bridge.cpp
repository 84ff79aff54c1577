#include "bridge.h"

#include "board.h"

void Bridge::begin(uint8_t channel) {
  channel_ = channel;
  const uint8_t pins[] = {PIN_POSITIVE[channel], PIN_NEGATIVE[channel], PIN_GROUND_OPEN[channel],
                          PIN_SET_POINT[channel]};
  for (uint8_t pin : pins) {
    digitalWrite(pin, LOW);
    pinMode(pin, OUTPUT);
  }
  set_point(0);
}

void Bridge::release() {
  set_point(0);
  if (sourcing()) move(OPEN);
}

void Bridge::step(int16_t wanted_v, uint16_t slew_v, bool discharged, uint8_t dead_time_ms) {
  if (dwell_ms_ < 255) ++dwell_ms_;
  const Contact polarity = wanted_v > 0 ? POSITIVE : wanted_v < 0 ? NEGATIVE : GROUND;
  const uint16_t wanted = abs(wanted_v);
  switch (contact_) {
    case OPEN:
      // A source that was just opened is followed by ground, never by the other source.
      if (dwell_ms_ > dead_time_ms) move(opened_from_ == GROUND ? polarity : GROUND);
      break;
    case GROUND:
      if (polarity != GROUND && discharged && dwell_ms_ > dead_time_ms) move(OPEN);
      break;
    default:
      if (contact_ == polarity) {
        if (wanted > set_point_v_) {
          set_point(set_point_v_ + min(slew_v, (uint16_t)(wanted - set_point_v_)));
        } else {
          set_point(set_point_v_ - min(slew_v, (uint16_t)(set_point_v_ - wanted)));
        }
      } else if (set_point_v_ > slew_v) {
        set_point(set_point_v_ - slew_v);
      } else {
        release();
      }
  }
}

void Bridge::move(Contact contact) {
  // Breaking comes first in this order of writes; between break and make lies the dead time in OPEN.
  if (contact != POSITIVE) write_pin(PIN_POSITIVE[channel_], false);
  if (contact != NEGATIVE) write_pin(PIN_NEGATIVE[channel_], false);
  write_pin(PIN_GROUND_OPEN[channel_], contact != GROUND);
  if (contact == POSITIVE) write_pin(PIN_POSITIVE[channel_], true);
  if (contact == NEGATIVE) write_pin(PIN_NEGATIVE[channel_], true);
  if (contact == POSITIVE) sign_ = 1;
  if (contact == NEGATIVE) sign_ = -1;
  opened_from_ = contact_;
  contact_ = contact;
  dwell_ms_ = 0;
}

void Bridge::set_point(uint16_t volts) {
  set_point_v_ = volts;
  // A compare value of 0 still gives a narrow pulse: take the pin from the timer instead.
  const uint8_t output = channel_ == 0 ? _BV(COM1A1) : _BV(COM1B1);
  const uint16_t count = volts == 0 ? 0 : min(calibration_.set_point(volts), (uint16_t)(FULL_SCALE_V - 1));
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {  // both a 16-bit register and bits of a shared one
    if (count == 0) {
      TCCR1A &= ~output;
    } else {
      TCCR1A |= output;
    }
    if (channel_ == 0) {
      OCR1A = count;
    } else {
      OCR1B = count;
    }
  }
}
