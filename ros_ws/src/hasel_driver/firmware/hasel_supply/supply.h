// The supply's state machine: modes, latched faults, watchdog, trips. tick() runs in the timer interrupt.
#pragma once

#include "board.h"
#include "bridge.h"
#include "waveform.h"

enum Mode : uint8_t { STANDBY, ARMED, ACTIVE, FAULT };
enum FaultCode : uint8_t { NONE, HEARTBEAT, OVERCURRENT, STOP, INTERLOCK, SEQUENCE, GARBAGE, OVERVOLTAGE };

extern const char* const MODE_NAMES[];
extern const char* const FAULT_NAMES[];

struct Settings {
  uint16_t maximum_v = 10000;
  uint16_t slew_v_per_ms = 400;
  uint16_t trip_ua = 450;
  uint16_t heartbeat_ms = 500;
};

struct Report {
  Mode mode;
  bool grounded;
  FaultCode fault;
  int16_t asked_v[CHANNELS];
  int16_t measured_v[CHANNELS];
  uint16_t current_ua[CHANNELS];
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
  bool start(const Waveform& waveform);
  void heard();  // a valid command: the heartbeat
  void set(const Settings& settings);
  Report report();
  FaultCode take_fault();      // a fault not yet reported, else NONE
  bool take_waveform_done();   // whether a waveform has ended since the last call

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
  void watch();
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
  uint16_t overvoltage_raw_ = 0;
  uint8_t over_current_ms_ = 0;
  uint8_t over_voltage_ms_ = 0;
};
