#include "commands.h"

#include <string.h>

#include "identity.h"

namespace {

int32_t clip(int32_t value, int32_t least, int32_t most) {
  return value < least ? least : value > most ? most : value;
}

template <typename Enumeration>
bool find(const char* word, const char* const* names, uint8_t count, Enumeration& found) {
  for (uint8_t i = 0; i < count; ++i) {
    if (strcmp(word, names[i]) == 0) {
      found = static_cast<Enumeration>(i);
      return true;
    }
  }
  return false;
}

const char* const CHANNEL_NAMES[] = {"upper", "lower"};

}  // namespace

void Commands::take(LineReader::Result result, char* text) {
  if (result == LineReader::NOTHING) return;
  if (result == LineReader::BAD_CHECKSUM) return unreadable("CHECKSUM");
  if (!split(text)) return unreadable("SYNTAX");
  const uint8_t sequence = atoi(text + 1);
  if (supply_.may_be_live() && sequence != (uint8_t)(sequence_ + 1)) {
    supply_.fail(SEQUENCE);
    sequence_ = sequence;
    return answer("SEQUENCE");
  }
  sequence_ = sequence;
  supply_.heard();
  answer(execute());
}

// Cuts ">nnn WORD WORD ..." into words_.
bool Commands::split(char* text) {
  for (uint8_t i = 1; i <= 3; ++i) {
    if (text[i] < '0' || text[i] > '9') return false;
  }
  if (text[0] != '>' || text[4] != ' ' || atoi(text + 1) > 255) return false;
  count_ = 0;
  for (char* word = strtok(text + 4, " "); word; word = strtok(nullptr, " ")) {
    if (count_ == MOST_WORDS) return false;
    words_[count_++] = word;
  }
  return count_ > 0;
}

bool Commands::is(uint8_t word, const char* text) const {
  return word < count_ && strcmp(words_[word], text) == 0;
}

bool Commands::number(uint8_t word, int32_t& value) const {
  const char* digits = words_[word];
  if (*digits == '-') ++digits;
  const size_t length = strlen(digits);
  if (length == 0 || length > 6 || strspn(digits, "0123456789") != length) return false;
  value = atol(words_[word]);
  return true;
}

const char* Commands::execute() {
  if (is(0, "SET")) return count_ < 2 ? "UNKNOWN" : set();
  if (is(0, "GET")) {
    if (!answerable()) return "UNKNOWN";
    uint8_t channel;
    if (is(1, "CALIBRATION")) {
      return count_ == 3 && find(words_[2], CHANNEL_NAMES, CHANNELS, channel) ? nullptr : "SYNTAX";
    }
    return count_ == 2 ? nullptr : "SYNTAX";
  }
  return simple();
}

const char* Commands::simple() {
  static const char* const known[] = {"PING", "ARM", "DISARM", "STOP", "CLEAR", "START", "GROUND"};
  uint8_t command;
  if (!find(words_[0], known, 7, command)) return "UNKNOWN";
  if (count_ > 1) return "SYNTAX";
  switch (command) {
    case 1:
      if (supply_.mode() != STANDBY) return "STATE";
      if (const char* reason = unsafe()) return reason;
      if (supply_.settings().maximum_v < LEAST_PULSE_V) return "MAXIMUM";
      return supply_.arm() ? nullptr : "STATE";
    case 2:
      supply_.disarm();
      return nullptr;
    case 3:
      supply_.fail(STOP);
      return nullptr;
    case 4:
      if (supply_.mode() != FAULT) return "STATE";
      if (const char* reason = unsafe()) return reason;
      if (supply_.needs_proof() && supply_.settings().maximum_v < LEAST_PULSE_V) return "MAXIMUM";
      return supply_.clear() ? nullptr : "STATE";
    case 5:
      return supply_.start(waveform_) ? nullptr : "STATE";
    case 6:
      return supply_.release() ? nullptr : "STATE";
    default:
      return nullptr;
  }
}

// Why the board must neither arm nor forget a fault; nullptr: nothing.
const char* Commands::unsafe() {
  if (supply_.interlock_open()) return "INTERLOCK";
  if (supply_.discrepancy()) return "DISCREPANCY";
  if (supply_.calibrations_damaged()) return "EEPROM";
  if (!supply_.grounded()) return "UNPROVEN";
  return nullptr;
}

const char* Commands::set() {
  if (is(1, "VOLTAGE")) return set_voltage();
  if (is(1, "WAVEFORM")) return set_waveform();
  if (is(1, "CALIBRATION")) return set_calibration();
  return set_setting();
}

const char* Commands::set_voltage() {
  if (!supply_.may_be_live()) return "STATE";
  int32_t upper, lower;
  if (count_ != 4 || !number(2, upper) || !number(3, lower)) return "SYNTAX";
  const int32_t most = supply_.settings().maximum_v;
  const int16_t voltage[CHANNELS] = {(int16_t)clip(upper, -most, most), (int16_t)clip(lower, -most, most)};
  return supply_.set_voltage(voltage) ? nullptr : "STATE";
}

const char* Commands::set_waveform() {
  if (supply_.mode() == ACTIVE) return "STATE";
  Waveform waveform;
  int32_t voltage, frequency, periods, duty;
  const bool readable = count_ == 9 && find(words_[2], SHAPE_NAMES, Waveform::SHAPES, waveform.shape) &&
                        number(3, voltage) && number(4, frequency) && number(5, periods) && number(6, duty) &&
                        find(words_[7], POLARITY_NAMES, Waveform::POLARITIES, waveform.polarity) &&
                        find(words_[8], MUSCLE_NAMES, Waveform::MUSCLE_ORDERS, waveform.muscles);
  if (!readable) return "SYNTAX";
  waveform.voltage_v = clip(voltage, 0, supply_.settings().maximum_v);
  waveform.frequency_mhz = clip(frequency, 10, 50000);
  waveform.periods = clip(periods, 1, 60000);
  waveform.duty = clip(duty, 1, 1000);
  waveform_ = waveform;
  return nullptr;
}

const char* Commands::set_setting() {
  int32_t value;
  const bool readable = count_ == 3 && number(2, value);
  if (is(1, "TELEMETRY")) {
    if (!readable) return "SYNTAX";
    telemetry_ms_ = clip(value, 10, 1000);
    return nullptr;
  }
  Settings settings = supply_.settings();
  uint16_t least, most;
  uint16_t* const target = setting(settings, least, most);
  if (!target) return "UNKNOWN";
  const bool lower = target == &settings.maximum_v && readable && value <= settings.maximum_v;
  if (supply_.may_be_live() && !lower) return "STATE";
  if (!readable) return "SYNTAX";
  *target = clip(value, least, most);
  if (lower) {
    supply_.lower_maximum(settings.maximum_v);
    waveform_.voltage_v = min(waveform_.voltage_v, (int16_t)settings.maximum_v);
  } else {
    supply_.set(settings);
  }
  return nullptr;
}

const char* Commands::set_calibration() {
  uint8_t channel;
  int32_t set_gain, set_offset, read_gain, read_offset;
  const bool readable = count_ == 7 && find(words_[2], CHANNEL_NAMES, CHANNELS, channel) && number(3, set_gain) &&
                        number(4, set_offset) && number(5, read_gain) && number(6, read_offset);
  if (!readable) return "SYNTAX";
  if (supply_.may_be_live()) return "STATE";
  Calibration calibration;
  calibration.set_gain = clip(set_gain, 9000, 11000);
  calibration.set_offset_v = clip(set_offset, -300, 300);
  calibration.read_gain = clip(read_gain, 9000, 11000);
  calibration.read_offset_v = clip(read_offset, -150, 150);  // less than what counts as discharged
  supply_.set_calibration(channel, calibration);
  return nullptr;
}

uint16_t* Commands::setting(Settings& settings, uint16_t& least, uint16_t& most) const {
  if (is(1, "MAXIMUM")) return least = 0, most = MOST_MAXIMUM_V, &settings.maximum_v;
  if (is(1, "SLEW")) return least = 1, most = 2000, &settings.slew_v_per_ms;
  if (is(1, "TRIP")) return least = 1, most = MOST_TRIP_UA, &settings.trip_ua;
  if (is(1, "HEARTBEAT")) return least = 100, most = 2000, &settings.heartbeat_ms;
  if (is(1, "DEADTIME")) return least = 2, most = 50, &settings.dead_time_ms;
  if (is(1, "CONTACTS")) return least = 0, most = 1, &settings.contacts;
  return nullptr;
}

bool Commands::answerable() const {
  Settings settings;
  uint16_t least, most;
  return is(1, "IDENTITY") || is(1, "VOLTAGE") || is(1, "WAVEFORM") || is(1, "TELEMETRY") ||
         is(1, "CALIBRATION") || setting(settings, least, most);
}

void Commands::answer(const char* refusal) {
  writer_.begin('<').add_sequence(sequence_).add(' ');
  if (refusal) {
    writer_.add("ERR ").add(refusal);
    for (uint8_t i = 0; i < count_; ++i) writer_.add(' ').add(words_[i]);
  } else if (is(0, "SET") || is(0, "GET")) {
    writer_.add("OK ").add(words_[1]).add(' ');
    add_value();
  } else {
    writer_.add("OK ").add(words_[0]);
  }
  writer_.send();
}

void Commands::add_value() {
  if (is(1, "IDENTITY")) {
    writer_.add(IDENTITY);
  } else if (is(1, "VOLTAGE")) {
    writer_.add_number(supply_.voltage_v(0)).add(' ').add_number(supply_.voltage_v(1));
  } else if (is(1, "TELEMETRY")) {
    writer_.add_unsigned(telemetry_ms_);
  } else if (is(1, "CALIBRATION")) {
    uint8_t channel = 0;
    find(words_[2], CHANNEL_NAMES, CHANNELS, channel);
    const Calibration& calibration = supply_.calibration(channel);
    writer_.add(words_[2]).add(' ').add_number(calibration.set_gain).add(' ').add_number(calibration.set_offset_v);
    writer_.add(' ').add_number(calibration.read_gain).add(' ').add_number(calibration.read_offset_v);
  } else if (is(1, "WAVEFORM")) {
    writer_.add(SHAPE_NAMES[waveform_.shape]).add(' ').add_number(waveform_.voltage_v);
    writer_.add(' ').add_unsigned(waveform_.frequency_mhz).add(' ').add_unsigned(waveform_.periods);
    writer_.add(' ').add_unsigned(waveform_.duty).add(' ').add(POLARITY_NAMES[waveform_.polarity]);
    writer_.add(' ').add(MUSCLE_NAMES[waveform_.muscles]);
  } else {
    Settings settings = supply_.settings();
    uint16_t least, most;
    writer_.add_unsigned(*setting(settings, least, most));
  }
}

void Commands::unreadable(const char* reason) {
  writer_.begin('<').add("--- ERR ").add(reason).send();
  if (supply_.may_be_live()) supply_.fail(GARBAGE);
}
