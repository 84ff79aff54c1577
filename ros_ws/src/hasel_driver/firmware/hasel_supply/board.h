// Pins and constants of the board: ATmega328P (Uno, Nano) at 16 MHz. Channel 0 is the upper muscle's.
#pragma once

#include <Arduino.h>
#include <util/atomic.h>

constexpr uint8_t CHANNELS = 2;

// Every output pin needs a pull-down resistor: from reset until setup() the pins float.
constexpr uint8_t PIN_CONVERTERS_ON = 8;               // enable of both converters
constexpr uint8_t PIN_POSITIVE[CHANNELS] = {2, 3};     // closes the positive contact
constexpr uint8_t PIN_NEGATIVE[CHANNELS] = {4, 5};     // closes the negative contact
constexpr uint8_t PIN_GROUND_OPEN[CHANNELS] = {6, 7};  // opens the normally closed ground contact
constexpr uint8_t PIN_SET_POINT[CHANNELS] = {9, 10};   // PWM of timer 1, 0 to 5 V for 0 to 10 kV
constexpr uint8_t PIN_INTERLOCK[2] = {12, 11};         // two channels, each low while stop button and enclosure are closed
constexpr uint8_t PIN_LIVE_LIGHT = 13;                 // lit while high voltage may be on
constexpr uint8_t PIN_CONTACT[CHANNELS] = {A4, A5};    // auxiliary contacts, low while the ground contact is closed; see CONTACTS

// Analogue inputs A0 to A3: voltage monitors (0 to 10 kV for 0 to 5 V), then current monitors (0 to 1 mA).
constexpr uint8_t ANALOGUE_INPUTS = 2 * CHANNELS;
constexpr uint16_t FULL_SCALE_V = 10000;
constexpr uint16_t FULL_SCALE_UA = 1000;
constexpr uint16_t ADC_MOST = 1023;
// Below the full scales, so that a monitor can still tell what is too much.
constexpr uint16_t MOST_MAXIMUM_V = 9800;
constexpr uint16_t MOST_TRIP_UA = 980;

constexpr uint16_t DISCHARGED_V = 200;
constexpr uint8_t CONFIRMATION_MS = 3;
constexpr uint8_t GROUND_PROOF_MS = 100;      // a closed ground contact must have discharged its muscle by then
constexpr uint16_t DISCREPANCY_MS = 500;      // the interlock's channels may differ that long

// The test pulse that proves the ground contacts.
constexpr uint16_t PULSE_V = 500;             // or MAXIMUM, where that is less
constexpr uint16_t LEAST_PULSE_V = 100;       // below it the monitors tell too little
constexpr uint16_t PULSE_SLEW_V = 10;         // per millisecond
constexpr uint16_t CHARGE_MS = 250;
constexpr uint8_t LEAK_MS = 20;               // with nothing connected, to see what leaks away by itself
constexpr uint16_t LEAST_FALL_V = 2 * DISCHARGED_V;  // from which a muscle grounded in use proves its contact anew
constexpr uint16_t LEAST_FORECAST_V = 20;     // two steps of the monitor: where leakage leaves less, nothing is proven

// A monitor that does not follow.
constexpr uint8_t STALE_MS = 3;               // inputs that were not converted for so long tell nothing
constexpr uint8_t BLIND_MS = 100;             // and for so long are a fault
constexpr uint16_t LEAST_FOLLOWED_V = 400;
constexpr uint16_t LOW_MS = 200;              // below half of what is asked for
constexpr uint16_t STUCK_MS = 350;            // at one value while what is asked for has changed by MOVED_V
constexpr uint16_t STUCK_V = 20, MOVED_V = 500;

static_assert(SERIAL_RX_BUFFER_SIZE >= 128, "two commands must fit: build with the Makefile, or with that buffer size");

// As digitalWrite, without its tables: interrupts are off for 2 us, which the serial port at 500 kbaud allows.
inline void write_pin(uint8_t pin, bool high) {
  volatile uint8_t& port = pin < 8 ? PORTD : PORTB;
  const uint8_t mask = _BV(pin & 7);
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { port = high ? port | mask : port & ~mask; }
}

// Raw reading of the converter for a quantity of the given full scale.
constexpr uint16_t raw(uint32_t value, uint16_t full_scale) {
  return value * ADC_MOST / full_scale;
}
