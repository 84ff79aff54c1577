// The supply's state machine: modes, latched faults, watchdog, trips. tick() runs in the timer interrupt.
#pragma once

#include "board.h"
#include "bridge.h"
#include "calibration.h"
#include "ground_evidence.h"
#include "ground_proof.h"
#include "latches.h"
#include "monitor_watch.h"
#include "waveform.h"

enum Mode : uint8_t { STANDBY, ARMED, ACTIVE, FAULT };
enum FaultCode : uint8_t { NONE, HEARTBEAT, OVERCURRENT, STOP, INTERLOCK, SEQUENCE, GARBAGE, OVERVOLTAGE, NOT_GROUNDED, MONITOR, EEPROM, DISCREPANCY };

extern const char* const MODE_NAMES[];
extern const char* const FAULT_NAMES[];

struct Settings {
  uint16_t maximum_v = 0;  // a board that nobody has set up gives no voltage
  uint16_t slew_v_per_ms = 250;
  uint16_t trip_ua = 450;
  uint16_t heartbeat_ms = 500;
  uint16_t dead_time_ms = 5;
  uint16_t contacts = 0;  // 1: auxiliary contacts are wired and read
};

// What is known of the output: live or unknown; contacts commanded to ground and little measured; proven besides.
enum Ground : uint8_t { NOT_GROUND, COMMANDED, PROVEN };

struct Report {
  Mode mode;
  Ground ground;
  FaultCode fault;
  int16_t asked_v[CHANNELS];
  int16_t measured_v[CHANNELS];
  uint16_t current_ua[CHANNELS];
  bool interlock_closed[2];
};

class Supply {
 public:
  // Called from loop(); each protects itself from tick().
  void begin();
  bool arm();  // begins the proof of ground, after which the mode is ARMED
  void disarm();
  bool clear();  // where the ground was not proven, begins its proof
  void fail(FaultCode code);
  bool set_voltage(const int16_t voltage_v[CHANNELS]);
  bool release();  // 0 V without waiting for the slew limit, still armed
  bool start(const Waveform& waveform);
  void heard();  // a valid command: the heartbeat
  void set(const Settings& settings);
  void lower_maximum(uint16_t maximum_v);  // in any mode; what is above it is discharged first
  void set_calibration(uint8_t channel, const Calibration& calibration);
  Report report();
  FaultCode take_fault();      // a fault not yet reported, else NONE
  bool take_waveform_done();   // whether a waveform has ended since the last call
  void keep_latches();         // in the EEPROM, where they have changed; takes some milliseconds then

  bool grounded() { return report().ground != NOT_GROUND; }
  bool needs_proof() const { return latches_ & UNPROVEN; }
  bool interlock_open() const;
  bool discrepancy() const { return latches_ & DISAGREED; }  // until both channels were open at once
  bool calibrations_damaged() const { return calibrations_damaged_; }
  const Calibration& calibration(uint8_t channel) const { return calibrations_[channel]; }
  const Settings& settings() const { return settings_; }
  Mode mode() const { return mode_; }
  bool may_be_live() const { return mode_ == ARMED || mode_ == ACTIVE; }
  int16_t voltage_v(uint8_t channel) const { return voltage_v_[channel]; }

  // Called from interrupts.
  bool tick();  // whether every analogue input was converted since the last
  void converted(uint8_t input, uint16_t value) {
    analogue_[input] = value;
    converted_ |= _BV(input);
  }

 private:
  void latch(FaultCode code);
  void ground(Mode mode);
  void ground_contacts();
  void begin_proof();
  void step_proof(const uint16_t measured_v[CHANNELS]);
  uint16_t measured_v(uint8_t channel, uint16_t analogue) const;
  bool contacts_closed(uint8_t channel) const;
  bool take_converted();
  void snapshot(uint16_t analogue[ANALOGUE_INPUTS]) const;
  bool discharged(const uint16_t analogue[ANALOGUE_INPUTS]) const;
  void watch(const uint16_t analogue[ANALOGUE_INPUTS], const uint16_t measured_v[CHANNELS]);
  void watch_ground(const uint16_t analogue[ANALOGUE_INPUTS]);
  void watch_interlock();
  void apply_waveform();
  bool confirmed(bool exceeded, uint8_t& count);

  Settings settings_;
  Bridge bridges_[CHANNELS];
  WaveformGenerator generator_;
  volatile Mode mode_ = STANDBY;
  volatile FaultCode fault_ = NONE;
  volatile bool fault_unreported_ = false;
  volatile bool waveform_done_ = false;
  volatile bool waveform_running_ = false;
  volatile bool proving_ = false;
  volatile uint16_t silent_ms_ = 0;
  int16_t voltage_v_[CHANNELS] = {0, 0};
  volatile uint16_t analogue_[ANALOGUE_INPUTS] = {0};
  volatile uint8_t converted_ = 0;  // one bit for each input
  volatile uint8_t stale_ms_ = STALE_MS;
  uint16_t trip_raw_ = 0;
  uint16_t overvoltage_raw_[CHANNELS] = {0};
  uint16_t discharged_raw_[CHANNELS] = {0};
  uint16_t monitor_scale_[CHANNELS] = {0};  // V per step of the converter, times 256
  Calibration calibrations_[CHANNELS];
  bool calibrations_damaged_ = false;
  GroundEvidence evidence_[CHANNELS];
  GroundProof proof_;
  MonitorWatch monitors_[CHANNELS];
  volatile uint8_t latches_ = 0;
  uint8_t kept_latches_ = 0;
  uint8_t not_grounded_ms_[CHANNELS] = {0};
  uint16_t discrepancy_ms_ = 0;
  uint8_t interlock_ms_ = 0;
  uint8_t over_current_ms_ = 0;
  uint8_t over_voltage_ms_ = 0;
};
