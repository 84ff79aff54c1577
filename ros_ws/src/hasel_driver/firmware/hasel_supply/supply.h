// The supply's state machine: modes, latched faults, watchdog, trips. tick() runs in the timer interrupt.
#pragma once

#include "board.h"
#include "bridge.h"
#include "calibration.h"
#include "waveform.h"

enum Mode : uint8_t { STANDBY, ARMED, ACTIVE, FAULT };
enum FaultCode : uint8_t { NONE, HEARTBEAT, OVERCURRENT, STOP, INTERLOCK, SEQUENCE, GARBAGE, OVERVOLTAGE, NOT_GROUNDED };

extern const char* const MODE_NAMES[];
extern const char* const FAULT_NAMES[];

struct Settings {
  uint16_t maximum_v = 0;  // a board that nobody has set up gives no voltage
  uint16_t slew_v_per_ms = 250;
  uint16_t trip_ua = 450;
  uint16_t heartbeat_ms = 500;
  uint16_t dead_time_ms = 5;
};

struct Report {
  Mode mode;
  bool grounded;  // by contact and measured voltage
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
  bool arm();
  void disarm();
  bool clear();
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

  bool grounded();  // proven by contact and measured voltage
  bool interlock_open() const;
  bool discrepancy() const { return discrepancy_; }  // until both channels were open at once
  const Calibration& calibration(uint8_t channel) const { return calibrations_[channel]; }
  const Settings& settings() const { return settings_; }
  Mode mode() const { return mode_; }
  bool may_be_live() const { return mode_ == ARMED || mode_ == ACTIVE; }
  int16_t voltage_v(uint8_t channel) const { return voltage_v_[channel]; }

  // Called from interrupts.
  void tick();
  void converted(uint8_t input, uint16_t value) { analogue_[input] = value; }

 private:
  void latch(FaultCode code);
  void ground(Mode mode);
  void ground_contacts();
  void snapshot(uint16_t analogue[ANALOGUE_INPUTS]) const;
  bool discharged(const uint16_t analogue[ANALOGUE_INPUTS]) const;
  void watch(const uint16_t analogue[ANALOGUE_INPUTS]);
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
  volatile uint16_t silent_ms_ = 0;
  int16_t voltage_v_[CHANNELS] = {0, 0};
  volatile uint16_t analogue_[ANALOGUE_INPUTS] = {0};
  uint16_t trip_raw_ = 0;
  uint16_t overvoltage_raw_[CHANNELS] = {0};
  uint16_t discharged_raw_[CHANNELS] = {0};
  Calibration calibrations_[CHANNELS];
  uint8_t not_grounded_ms_[CHANNELS] = {0};
  uint16_t discrepancy_ms_ = 0;
  volatile bool discrepancy_ = false;
  uint8_t over_current_ms_ = 0;
  uint8_t over_voltage_ms_ = 0;
};
