// Obeys the host's lines, as PROTOCOL.md says.
#pragma once

#include "lines.h"
#include "supply.h"

class Commands {
 public:
  Commands(Supply& supply, LineWriter& writer) : supply_(supply), writer_(writer) {}
  void take(LineReader::Result result, char* text);
  uint16_t telemetry_ms() const { return telemetry_ms_; }

 private:
  // nullptr: done; otherwise the reason of the refusal.
  const char* execute();
  const char* set();
  const char* set_voltage();
  const char* set_waveform();
  const char* set_setting();
  const char* set_calibration();
  const char* unsafe();
  const char* simple();
  bool split(char* text);
  bool number(uint8_t word, int32_t& value) const;
  bool is(uint8_t word, const char* text) const;
  uint16_t* setting(Settings& settings, uint16_t& least, uint16_t& most) const;
  bool answerable() const;
  void answer(const char* refusal);
  void add_value();
  void unreadable(const char* reason);

  static constexpr uint8_t MOST_WORDS = 10;

  Supply& supply_;
  LineWriter& writer_;
  Waveform waveform_;
  uint16_t telemetry_ms_ = 10;
  uint8_t sequence_ = 0;
  const char* words_[MOST_WORDS];
  uint8_t count_ = 0;
};
