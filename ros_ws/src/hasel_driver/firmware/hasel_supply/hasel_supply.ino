// High-voltage supply for two HASEL muscles: see PROTOCOL.md for the serial protocol, board.h for the pins.
//
// The timer interrupt watches heartbeat, interlock, trips and ground every millisecond. The hardware watchdog resets
// the chip, hence grounds the output, unless both go on: loop() feeds it, and only after a tick
// that has run with every analogue input converted since the one before.

#include <avr/sleep.h>
#include <avr/wdt.h>

#include "board.h"
#include "commands.h"
#include "identity.h"
#include "lines.h"
#include "supply.h"

static Supply supply;
static LineReader reader;
static LineWriter writer;
static Commands commands(supply, writer);
static volatile bool ticked = false, sound = false;
static uint8_t reset_flags __attribute__((section(".noinit")));

// Optiboot clears MCUSR, and hands it on in r2.
static uint8_t boot_loader_flags __attribute__((section(".noinit")));
void keep_boot_loader_flags() __attribute__((naked, used, section(".init0")));
void keep_boot_loader_flags() {
  asm volatile("sts %0, r2\n" : "=m"(boot_loader_flags));
}

// The watchdog stays on through a reset: stop it before anything slow.
void stop_watchdog() __attribute__((naked, used, section(".init3")));
void stop_watchdog() {
  reset_flags = MCUSR ? MCUSR : boot_loader_flags;
  MCUSR = 0;
  wdt_disable();
}

static const char* reset_cause() {
  if (reset_flags & _BV(WDRF)) return "watchdog";
  if (reset_flags & _BV(BORF)) return "brownout";
  if (reset_flags & _BV(EXTRF)) return "external";
  if (reset_flags & _BV(PORF)) return "power";
  return "unknown";
}

static void start_timers() {
  // Timer 1: fast PWM, one count per volt.
  TCCR1A = _BV(WGM11);
  TCCR1B = _BV(WGM13) | _BV(WGM12) | _BV(CS10);
  ICR1 = FULL_SCALE_V - 1;
  // Timer 2: the 1 ms tick.
  TCCR2A = _BV(WGM21);
  TCCR2B = _BV(CS22) | _BV(CS20);
  OCR2A = F_CPU / 128 / 1000 - 1;
  TIMSK2 = _BV(OCIE2A);
  // Analogue inputs against 5 V, 104 us each, one after the other from each tick.
  ADMUX = _BV(REFS0);
  ADCSRA = _BV(ADEN) | _BV(ADIE) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);
}

// Interrupts stay on, for the serial port; a tick that outlasts a millisecond skips the next.
ISR(TIMER2_COMPA_vect, ISR_NOBLOCK) {
  static volatile bool running = false;
  if (running) return;
  running = true;
  if (!(ADCSRA & _BV(ADSC))) {
    ADMUX = _BV(REFS0);
    ADCSRA |= _BV(ADSC);
  }
  if (supply.tick()) sound = true;
  ticked = true;
  running = false;
}

ISR(ADC_vect) {
  const uint8_t input = ADMUX & 0x07;
  supply.converted(input, ADC);
  if (input + 1 < ANALOGUE_INPUTS) {
    ADMUX = _BV(REFS0) | (input + 1);
    ADCSRA |= _BV(ADSC);
  }
}

static void send_events() {
  const FaultCode fault = supply.take_fault();
  if (fault != NONE) writer.begin('!').add("FAULT ").add_unsigned(fault).add(' ').add(FAULT_NAMES[fault]).send();
  if (supply.take_waveform_done()) writer.begin('!').add("WAVEFORM DONE").send();
}

static void send_telemetry() {
  static uint32_t last_ms = 0;
  if (millis() - last_ms < commands.telemetry_ms()) return;
  last_ms = millis();
  const uint32_t time_us = micros();
  const Report report = supply.report();
  writer.begin('#').add("t=").add_unsigned(time_us).add(" s=").add(MODE_NAMES[report.mode]);
  writer.add(" g=").add_unsigned(report.ground).add(" f=").add_unsigned(report.fault);
  writer.add(" v=").add_number(report.asked_v[0]).add(',').add_number(report.asked_v[1]);
  writer.add(" m=").add_number(report.measured_v[0]).add(',').add_number(report.measured_v[1]);
  writer.add(" i=").add_unsigned(report.current_ua[0]).add(',').add_unsigned(report.current_ua[1]);
  writer.add(" k=").add_unsigned(report.interlock_closed[0]).add_unsigned(report.interlock_closed[1]);
  writer.add(" x=").add_unsigned(supply.settings().maximum_v).send();
}

void setup() {
  supply.begin();
  Serial.begin(500000);
  writer.begin('!').add("BOOT ").add(IDENTITY).add(" reset=").add(reset_cause()).send();
  start_timers();
  wdt_enable(WDTO_250MS);
  set_sleep_mode(SLEEP_MODE_IDLE);
}

void loop() {
  ticked = false;
  if (sound) {
    sound = false;
    wdt_reset();
  }
  // Only what is there now: an endless stream must not keep the watchdog from being fed.
  for (int count = Serial.available(); count > 0; --count) {
    commands.take(reader.take(Serial.read()), reader.text());
  }
  send_events();
  supply.keep_latches();
  send_telemetry();
  writer.pump();
  while (!ticked && !Serial.available()) sleep_mode();
}
