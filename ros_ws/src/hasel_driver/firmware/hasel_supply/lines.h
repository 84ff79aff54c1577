// Lines with checksum in and out of the serial port, without ever waiting for it.
#pragma once

#include <stddef.h>
#include <stdint.h>

constexpr uint8_t MAXIMUM_LINE_LENGTH = 96;

class LineReader {
 public:
  enum Result : uint8_t { NOTHING, GOOD, BAD_CHECKSUM };
  // Takes one character; after GOOD, text() is the line without its checksum.
  Result take(char character);
  char* text() { return text_; }

 private:
  Result finish();

  char text_[MAXIMUM_LINE_LENGTH + 1];
  uint8_t length_ = 0;
  bool overlong_ = false;
};

class LineWriter {
 public:
  LineWriter& begin(char first);
  LineWriter& add(const char* text);
  LineWriter& add(char character);
  LineWriter& add_number(int32_t value);
  LineWriter& add_unsigned(uint32_t value);
  LineWriter& add_sequence(uint8_t sequence);
  // Queues the line; one that does not fit is dropped whole.
  void send();
  // Hands queued characters to the port as far as it takes them at once.
  void pump();

 private:
  char line_[MAXIMUM_LINE_LENGTH + 1];
  uint8_t length_ = 0;
  char queue_[256];
  uint16_t head_ = 0;
  uint16_t count_ = 0;
};
