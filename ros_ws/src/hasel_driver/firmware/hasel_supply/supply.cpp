#include "supply.h"

#include <util/atomic.h>

const char* const MODE_NAMES[] = {"STANDBY", "ARMED", "ACTIVE", "FAULT"};
const char* const FAULT_NAMES[] = {"NONE",      "HEARTBEAT", "OVERCURRENT", "STOP",
                                   "INTERLOCK", "SEQUENCE",  "GARBAGE",     "OVERVOLTAGE",
                                   "NOT_GROUNDED", "MONITOR", "EEPROM", "DISCREPANCY"};

void Supply::begin() {
  write_pin(PIN_CONVERTERS_ON, false);
  pinMode(PIN_CONVERTERS_ON, OUTPUT);
  pinMode(PIN_LIVE_LIGHT, OUTPUT);
  for (uint8_t pin : PIN_INTERLOCK) pinMode(pin, INPUT_PULLUP);
  for (uint8_t pin : PIN_CONTACT) pinMode(pin, INPUT_PULLUP);
  calibrations_damaged_ = !load_calibrations(calibrations_);
  latches_ = kept_latches_ = load_latches();
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    bridges_[channel].begin(channel);
    bridges_[channel].calibrate(calibrations_[channel]);
  }
  set(Settings());
  if (latches_ & UNPROVEN) latch(NOT_GROUNDED);
  if (latches_ & DISAGREED) latch(DISCREPANCY);
  if (calibrations_damaged_) latch(EEPROM);
}

void Supply::set(const Settings& settings) {
  const uint16_t trip_raw = raw(settings.trip_ua, FULL_SCALE_UA);
  const uint16_t most_v = max(settings.maximum_v * 105UL / 100, settings.maximum_v + 100UL);
  uint16_t overvoltage_raw[CHANNELS], discharged_raw[CHANNELS], monitor_scale[CHANNELS];
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    const Calibration& calibration = calibrations_[channel];
    // A monitor at the end of its range cannot tell how much there is: that too is more than allowed.
    overvoltage_raw[channel] = min(raw(calibration.monitored(most_v), FULL_SCALE_V), (uint16_t)(ADC_MOST - 1));
    discharged_raw[channel] = raw(calibration.monitored(DISCHARGED_V), FULL_SCALE_V);
    monitor_scale[channel] = FULL_SCALE_V * 256UL / ADC_MOST * calibration.read_gain / Calibration::UNITY;
  }
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    settings_ = settings;
    trip_raw_ = min(trip_raw, (uint16_t)(ADC_MOST - 1));
    for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
      overvoltage_raw_[channel] = overvoltage_raw[channel];
      discharged_raw_[channel] = discharged_raw[channel];
      monitor_scale_[channel] = monitor_scale[channel];
    }
  }
}

void Supply::lower_maximum(uint16_t maximum_v) {
  Settings settings = settings_;
  settings.maximum_v = maximum_v;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
      // The converter cannot sink: let go, discharge to ground, and come back with less.
      if (bridges_[channel].set_point_v() > maximum_v) bridges_[channel].release();
      voltage_v_[channel] = constrain(voltage_v_[channel], -(int16_t)maximum_v, (int16_t)maximum_v);
    }
    settings_.maximum_v = maximum_v;
  }
  set(settings);
}

void Supply::set_calibration(uint8_t channel, const Calibration& calibration) {
  calibrations_[channel] = calibration;
  bridges_[channel].calibrate(calibration);
  store_calibrations(calibrations_);
  calibrations_damaged_ = false;
  set(settings_);
}

bool Supply::arm() {
  bool done = false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    done = mode_ == STANDBY;
    if (done) begin_proof();
  }
  return done;
}

void Supply::disarm() {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { ground(fault_ == NONE ? STANDBY : FAULT); }
}

bool Supply::clear() {
  bool done = false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    done = mode_ == FAULT;
    if (done && needs_proof()) {
      begin_proof();
    } else if (done) {
      fault_ = NONE;
      mode_ = STANDBY;
    }
  }
  return done;
}

void Supply::begin_proof() {
  silent_ms_ = 0;
  over_current_ms_ = over_voltage_ms_ = 0;
  for (MonitorWatch& monitor : monitors_) monitor.begin();
  proof_.begin(min(PULSE_V, settings_.maximum_v));
  proving_ = true;
  mode_ = ACTIVE;
}

void Supply::fail(FaultCode code) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { latch(code); }
}

bool Supply::set_voltage(const int16_t voltage_v[CHANNELS]) {
  bool done = false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (may_be_live() && !proving_) {
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
  WaveformGenerator generator;
  generator.start(waveform);  // its divisions take too long with interrupts off
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (mode_ == ARMED) {
      generator_ = generator;
      waveform_running_ = true;
      mode_ = ACTIVE;
      done = true;
    }
  }
  return done;
}

bool Supply::release() {
  bool done = false;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (may_be_live() && !proving_) {
      waveform_running_ = false;
      ground_contacts();
      mode_ = ARMED;
      done = true;
    }
  }
  return done;
}

void Supply::heard() {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { silent_ms_ = 0; }
}

bool Supply::interlock_open() const {
  return digitalRead(PIN_INTERLOCK[0]) == HIGH || digitalRead(PIN_INTERLOCK[1]) == HIGH;
}

void Supply::snapshot(uint16_t analogue[ANALOGUE_INPUTS]) const {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    for (uint8_t input = 0; input < ANALOGUE_INPUTS; ++input) analogue[input] = analogue_[input];
  }
}

bool Supply::discharged(const uint16_t analogue[ANALOGUE_INPUTS]) const {
  return analogue[0] < discharged_raw_[0] && analogue[1] < discharged_raw_[1];
}

// Within some volts of what report() tells, without its divisions, which take too long for every tick.
uint16_t Supply::measured_v(uint8_t channel, uint16_t analogue) const {
  const int32_t volts = ((uint32_t)analogue * monitor_scale_[channel] >> 8) + calibrations_[channel].read_offset_v;
  return volts < 0 ? 0 : volts;
}

// By what was commanded, and by the auxiliary contact where it is wired.
bool Supply::contacts_closed(uint8_t channel) const {
  return bridges_[channel].grounded() && (!settings_.contacts || digitalRead(PIN_CONTACT[channel]) == LOW);
}

bool Supply::take_converted() {
  bool all;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    all = converted_ == _BV(ANALOGUE_INPUTS) - 1;
    converted_ = 0;
  }
  return all;
}

void Supply::keep_latches() {
  const uint8_t latches = latches_;
  if (latches == kept_latches_) return;
  store_latches(latches);
  kept_latches_ = latches;
}

Report Supply::report() {
  Report report;
  uint16_t analogue[ANALOGUE_INPUTS];
  bool contacts, proven, fresh;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    report.mode = mode_;
    report.fault = fault_;
    contacts = contacts_closed(0) && contacts_closed(1);
    proven = settings_.contacts || (evidence_[0].proven() && evidence_[1].proven());
    fresh = stale_ms_ < STALE_MS;
    for (uint8_t channel = 0; channel < CHANNELS; ++channel) report.asked_v[channel] = voltage_v_[channel];
    snapshot(analogue);
  }
  report.ground = !(contacts && fresh && discharged(analogue)) ? NOT_GROUND : proven && !needs_proof() ? PROVEN : COMMANDED;
  if (report.mode == ARMED && !contacts) report.mode = ACTIVE;
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    const int16_t volts = calibrations_[channel].measured((uint32_t)analogue[channel] * FULL_SCALE_V / ADC_MOST);
    report.measured_v[channel] = bridges_[channel].sign() < 0 ? -volts : volts;
    report.current_ua[channel] = (uint32_t)analogue[CHANNELS + channel] * FULL_SCALE_UA / ADC_MOST;
    report.interlock_closed[channel] = digitalRead(PIN_INTERLOCK[channel]) == LOW;
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

bool Supply::tick() {
  uint16_t analogue[ANALOGUE_INPUTS];
  snapshot(analogue);  // the converter's interrupt writes two bytes one after the other
  const bool converted = take_converted();
  stale_ms_ = converted ? 0 : min(stale_ms_ + 1, (int)BLIND_MS);
  if (stale_ms_ >= BLIND_MS) latch(MONITOR);
  uint16_t measured_v[CHANNELS];
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) measured_v[channel] = this->measured_v(channel, analogue[channel]);
  if (silent_ms_ < 0xFFFF) ++silent_ms_;
  watch_interlock();
  watch_ground(analogue);
  if (may_be_live()) watch(analogue, measured_v);
  if (proving_) step_proof(measured_v);
  if (may_be_live() && waveform_running_) apply_waveform();
  const bool live = may_be_live(), proving = proving_;
  const uint16_t slew_v = proving ? PULSE_SLEW_V : settings_.slew_v_per_ms;
  const uint8_t dead_time_ms = proving ? max(settings_.dead_time_ms, (uint16_t)LEAK_MS) : settings_.dead_time_ms;
  bool grounded = true;
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    const bool discharged = analogue[channel] < discharged_raw_[channel];
    const int16_t wanted_v = proving ? min(proof_.wanted_v(), (int16_t)settings_.maximum_v) : voltage_v_[channel];
    bridges_[channel].step(live ? wanted_v : 0, slew_v, discharged, dead_time_ms);
    evidence_[channel].step(contacts_closed(channel), measured_v[channel], proving ? LEAST_PULSE_V / 2 : LEAST_FALL_V);
    grounded = grounded && bridges_[channel].grounded();
  }
  write_pin(PIN_CONVERTERS_ON, live && !grounded);
  write_pin(PIN_LIVE_LIGHT, live || !grounded || !this->discharged(analogue));
  return converted;
}

void Supply::step_proof(const uint16_t measured_v[CHANNELS]) {
  const GroundProof::Verdict verdict = proof_.step(measured_v, contacts_closed(0) && contacts_closed(1), evidence_);
  if (verdict == GroundProof::NOT_CHARGED) return latch(needs_proof() ? NOT_GROUNDED : MONITOR);
  if (verdict == GroundProof::NOT_GROUNDED) return latch(NOT_GROUNDED);
  if (verdict == GroundProof::PROVEN) {
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
      proving_ = false;
      mode_ = fault_ == NONE ? ARMED : STANDBY;
      fault_ = NONE;
      latches_ &= ~UNPROVEN;
    }
  } else if (proof_.wanted_v() == 0) {
    ground_contacts();
  }
}

void Supply::watch_interlock() {
  const bool first = digitalRead(PIN_INTERLOCK[0]) == HIGH, second = digitalRead(PIN_INTERLOCK[1]) == HIGH;
  if (first && second) latches_ &= ~DISAGREED;
  discrepancy_ms_ = first == second ? 0 : discrepancy_ms_ + 1;
  if (discrepancy_ms_ > DISCREPANCY_MS) {
    discrepancy_ms_ = DISCREPANCY_MS;
    latches_ |= DISAGREED;
    latch(DISCREPANCY);
  }
}

void Supply::watch_ground(const uint16_t analogue[ANALOGUE_INPUTS]) {
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    const bool charged = bridges_[channel].grounded() && (analogue[channel] >= discharged_raw_[channel] || !contacts_closed(channel));
    not_grounded_ms_[channel] = charged ? not_grounded_ms_[channel] + 1 : 0;
    if (not_grounded_ms_[channel] < GROUND_PROOF_MS) continue;
    not_grounded_ms_[channel] = GROUND_PROOF_MS;
    latch(NOT_GROUNDED);
  }
}

void Supply::watch(const uint16_t analogue[ANALOGUE_INPUTS], const uint16_t measured_v[CHANNELS]) {
  if (confirmed(interlock_open(), interlock_ms_)) {
    latch(INTERLOCK);
  } else if (silent_ms_ > settings_.heartbeat_ms) {
    latch(HEARTBEAT);
  }
  const bool over_current = analogue[2] > trip_raw_ || analogue[3] > trip_raw_;
  if (confirmed(over_current, over_current_ms_)) latch(OVERCURRENT);
  bool over_voltage = false, unfollowed = false;
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    over_voltage |= bridges_[channel].sourcing() && analogue[channel] > overvoltage_raw_[channel];
    if (bridges_[channel].sourcing()) unfollowed |= monitors_[channel].step(bridges_[channel].set_point_v(), measured_v[channel]);
  }
  if (confirmed(over_voltage, over_voltage_ms_)) latch(OVERVOLTAGE);
  if (unfollowed) latch(MONITOR);
}

bool Supply::confirmed(bool exceeded, uint8_t& count) {
  count = exceeded ? count + 1 : 0;
  return count >= CONFIRMATION_MS;
}

void Supply::apply_waveform() {
  const bool running = generator_.next(voltage_v_);
  const int16_t most = settings_.maximum_v;
  for (int16_t& voltage : voltage_v_) voltage = constrain(voltage, -most, most);
  if (!running) {
    waveform_running_ = false;
    waveform_done_ = true;
    mode_ = ARMED;
  }
}

void Supply::latch(FaultCode code) {
  ground(FAULT);
  if (code == NOT_GROUNDED) latches_ |= UNPROVEN;
  if (fault_ == NONE) {
    fault_ = code;
    fault_unreported_ = true;
  }
}

void Supply::ground(Mode mode) {
  mode_ = mode;
  waveform_running_ = proving_ = false;
  write_pin(PIN_CONVERTERS_ON, false);
  ground_contacts();
}

void Supply::ground_contacts() {
  for (uint8_t channel = 0; channel < CHANNELS; ++channel) {
    voltage_v_[channel] = 0;
    bridges_[channel].release();
  }
}
