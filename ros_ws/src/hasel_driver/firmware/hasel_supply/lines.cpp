#include "lines.h"

#include <Arduino.h>
#include <util/crc16.h>

namespace {

constexpr uint8_t CHECKSUM_LENGTH = 5;  // with its asterisk

uint16_t checksum(const char* text, uint8_t length) {
  uint16_t crc = 0;
  for (uint8_t i = 0; i < length; ++i) crc = _crc_xmodem_update(crc, text[i]);
  return crc;
}

char hexadecimal(uint8_t digit) {
  return digit < 10 ? '0' + digit : 'A' + digit - 10;
}

void write_checksum(char* target, uint16_t crc) {
  target[0] = '*';
  for (uint8_t i = 0; i < 4; ++i) target[1 + i] = hexadecimal((crc >> (12 - 4 * i)) & 0xF);
}

}  // namespace

LineReader::Result LineReader::take(char character) {
  if (character == '\n') return finish();
  if (length_ < MAXIMUM_LINE_LENGTH) {
    text_[length_++] = character;
  } else {
    overlong_ = true;
  }
  return NOTHING;
}

LineReader::Result LineReader::finish() {
  if (length_ > 0 && text_[length_ - 1] == '\r') --length_;
  const uint8_t length = length_;
  const bool overlong = overlong_;
  length_ = 0;
  overlong_ = false;
  if (length == 0) return NOTHING;
  if (overlong || length < CHECKSUM_LENGTH) return BAD_CHECKSUM;
  const uint8_t body = length - CHECKSUM_LENGTH;
  char expected[CHECKSUM_LENGTH];
  write_checksum(expected, checksum(text_, body));
  if (memcmp(expected, text_ + body, CHECKSUM_LENGTH) != 0) return BAD_CHECKSUM;
  text_[body] = '\0';
  return GOOD;
}

LineWriter& LineWriter::begin(char first) {
  length_ = 0;
  return add(first);
}

LineWriter& LineWriter::add(char character) {
  if (length_ < MAXIMUM_LINE_LENGTH - CHECKSUM_LENGTH) line_[length_++] = character;
  return *this;
}

LineWriter& LineWriter::add(const char* text) {
  while (*text) add(*text++);
  return *this;
}

LineWriter& LineWriter::add_number(int32_t value) {
  char digits[12];
  return add(ltoa(value, digits, 10));
}

LineWriter& LineWriter::add_unsigned(uint32_t value) {
  char digits[12];
  return add(ultoa(value, digits, 10));
}

LineWriter& LineWriter::add_sequence(uint8_t sequence) {
  return add('0' + sequence / 100).add('0' + sequence / 10 % 10).add('0' + sequence % 10);
}

void LineWriter::send() {
  write_checksum(line_ + length_, checksum(line_, length_));
  length_ += CHECKSUM_LENGTH;
  line_[length_++] = '\n';
  if (sizeof(queue_) - count_ < length_) return;
  for (uint8_t i = 0; i < length_; ++i) queue_[(head_ + count_++) % sizeof(queue_)] = line_[i];
}

void LineWriter::pump() {
  while (count_ > 0 && Serial.availableForWrite() > 0) {
    Serial.write(queue_[head_]);
    head_ = (head_ + 1) % sizeof(queue_);
    --count_;
  }
}
