#include "supply.h"

#include <util/atomic.h>

const char* const MODE_NAMES[] = {"STANDBY", "ARMED", "ACTIVE", "FAULT"};
const char* const FAULT_NAMES[] = {"NONE",      "HEARTBEAT", "OVERCURRENT", "STOP",
                                   "INTERLOCK", "SEQUENCE",  "GARBAGE",     "OVERVOLTAGE"};

void Supply::begin() {
  digitalWrite(PIN_CONVERTERS_ON, LOW);
  pinMode(PIN_CONVERTERS_ON, OUTPUT);
  pinMode(PIN_LIVE_LIGHT, OUTPUT);
  pinMode(PIN_INTERLOCK, INPUT_PULLUP);
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) bridges_[channel].begin(channel);
  set(Settings());
}

void Supply::set(const Settings& settings) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    settings_ = settings;
    trip_raw_ = raw(settings.trip_ua, FULL_SCALE_UA);
    const uint32_t most_v = max(settings.maximum_v * 105UL / 100, settings.maximum_v + 100UL);
    overvoltage_raw_ = most_v < FULL_SCALE_V ? raw(most_v, FULL_SCALE_V) : ADC_MOST;
  }
}

bool Supply::arm() {
  if (mode_ != STANDBY) return false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    silent_ms_ = 0;
    over_current_ms_ = over_voltage_ms_ = 0;
    mode_ = ARMED;
  }
  return true;
}

void Supply::disarm() {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { ground(fault_ == NONE ? STANDBY : FAULT); }
}

bool Supply::clear() {
  if (mode_ != FAULT) return false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    fault_ = NONE;
    mode_ = STANDBY;
  }
  return true;
}

void Supply::fail(FaultCode code) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { latch(code); }
}

bool Supply::set_voltage(const int16_t voltage_v[CHANNELS]) {
  bool done = false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (may_be_live()) {
      waveform_running_ = false;
      for (uint8_t channel = 0; channel < CHANNELS; ++channel) voltage_v_[channel] = voltage_v[channel];
      mode_ = voltage_v[0] || voltage_v[1] ? ACTIVE : ARMED;
      done = true;
    }
  }
  return done;
}

bool Supply::start(const Waveform& waveform) {
  bool done = false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (mode_ == ARMED) {
      generator_.start(waveform);
      waveform_running_ = true;
      mode_ = ACTIVE;
      done = true;
    }
  }
  return done;
}

void Supply::heard() {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { silent_ms_ = 0; }
}

Report Supply::report() {
  Report report;
  uint16_t analogue[ANALOGUE_INPUTS];
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    report.mode = mode_;
    report.fault = fault_;
    report.grounded = bridges_[0].grounded() && bridges_[1].grounded();
    for (uint8_t channel = 0; channel < CHANNELS; ++channel) report.asked_v[channel] = voltage_v_[channel];
    for (uint8_t input = 0; input < ANALOGUE_INPUTS; ++input) analogue[input] = analogue_[input];
  }
  if (report.mode == ARMED && !report.grounded) report.mode = ACTIVE;
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    const int16_t volts = (uint32_t)analogue[channel] * FULL_SCALE_V / ADC_MOST;
    report.measured_v[channel] = bridges_[channel].sign() < 0 ? -volts : volts;
    report.current_ua[channel] = (uint32_t)analogue[CHANNELS + channel] * FULL_SCALE_UA / ADC_MOST;
  }
  return report;
}

FaultCode Supply::take_fault() {
  FaultCode code = NONE;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (fault_unreported_) code = fault_;
    fault_unreported_ = false;
  }
  return code;
}

bool Supply::take_waveform_done() {
  bool done;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    done = waveform_done_;
    waveform_done_ = false;
  }
  return done;
}

void Supply::tick() {
  if (silent_ms_ < 0xFFFF) ++silent_ms_;
  if (may_be_live()) watch();
  if (may_be_live() && waveform_running_) apply_waveform();
  const bool live = may_be_live();
  bool grounded = true;
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    const bool discharged = analogue_[channel] < raw(DISCHARGED_V, FULL_SCALE_V);
    bridges_[channel].step(live ? voltage_v_[channel] : 0, settings_.slew_v_per_ms, discharged);
    grounded = grounded && bridges_[channel].grounded();
  }
  digitalWrite(PIN_CONVERTERS_ON, live && !grounded ? HIGH : LOW);
  digitalWrite(PIN_LIVE_LIGHT, live || !grounded ? HIGH : LOW);
}

void Supply::watch() {
  if (digitalRead(PIN_INTERLOCK) == HIGH) {
    latch(INTERLOCK);
  } else if (silent_ms_ > settings_.heartbeat_ms) {
    latch(HEARTBEAT);
  }
  const bool over_current = analogue_[2] > trip_raw_ || analogue_[3] > trip_raw_;
  if (confirmed(over_current, over_current_ms_)) latch(OVERCURRENT);
  const bool over_voltage = analogue_[0] > overvoltage_raw_ || analogue_[1] > overvoltage_raw_;
  if (confirmed(over_voltage, over_voltage_ms_)) latch(OVERVOLTAGE);
}

bool Supply::confirmed(bool exceeded, uint8_t& count) {
  count = exceeded ? count + 1 : 0;
  return count >= CONFIRMATION_MS;
}

void Supply::apply_waveform() {
  if (!generator_.next(voltage_v_)) {
    waveform_running_ = false;
    waveform_done_ = true;
    mode_ = ARMED;
  }
}

void Supply::latch(FaultCode code) {
  ground(FAULT);
  if (fault_ == NONE) {
    fault_ = code;
    fault_unreported_ = true;
  }
}

void Supply::ground(Mode mode) {
  mode_ = mode;
  waveform_running_ = false;
  digitalWrite(PIN_CONVERTERS_ON, LOW);
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    voltage_v_[channel] = 0;
    bridges_[channel].release();
  }
}
