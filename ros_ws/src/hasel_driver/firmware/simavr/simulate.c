// Runs the sketch in simavr in real time, with two muscles on its pins and its serial port on a
// pseudo-terminal. Standard input and output speak as those of `virtual_supply` do, and `contacts` tells how
// often a source overlapped with the other or with ground, and the shortest gap between them [us]. `late` [s]
// tells that the machine did not keep up with real time.
#define _GNU_SOURCE
#include <math.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "avr_adc.h"
#include "avr_eeprom.h"
#include "avr_extint.h"
#include "avr_ioport.h"
#include "avr_uart.h"
#include "muscle.h"
#include "port.h"
#include "sim_avr.h"
#include "sim_elf.h"
#include "trace.h"

enum { CHANNELS = 2, FREQUENCY_HZ = 16000000, TICK_CYCLES = 16000, BYTE_CYCLES = 320 };
enum { DDRB = 0x24, PORTB, DDRD = 0x2A, PORTD, TIMSK2 = 0x70, ADCSRA = 0x7A, ADIE = 3, TCCR1A = 0x80, OCR1A = 0x88, OCR1B = 0x8A };
static const double LIVE_V = 50.0;
static const uint32_t HANG_ADDRESS = 0x7F00;
static const uint64_t LATE_CYCLES = FREQUENCY_HZ / 20, MOST_LAG_CYCLES = FREQUENCY_HZ / 10;

static avr_t* avr;
static avr_irq_t *analogue_irqs, *uart_irqs;
static struct port port;
static struct muscle muscles[CHANNELS];
static double peaks_v[CHANNELS];
static uint16_t compare_values[CHANNELS];
static bool interlock_open[2], boot_lost;
struct hardware {
  bool contact_welded, ground_broken;
  double set_point_gain, monitor_gain;
  double stuck_v;  // what the monitor says for good; negative: the truth
};
static const struct hardware WHOLE = {.set_point_gain = 1.0, .monitor_gain = 1.0, .stuck_v = -1.0};
static struct hardware hardware[CHANNELS];
static int broken;  // channel that is broken by what is injected
static bool live, silent, deaf, noise, truncate_next, uart_full, host_present, tracing;
static char received[4096];
static size_t received_count;
static char transmitted[4096];
static size_t transmitted_count;
static unsigned overlaps;
static uint64_t source_opened[CHANNELS], ground_opened[CHANNELS], shortest_gap = UINT64_MAX;
static enum contact contacts[CHANNELS];

static double now_s(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec + time.tv_nsec * 1e-9;
}

static bool high(uint8_t pin) {
  const uint8_t data = pin < 8 ? avr->data[PORTD] & avr->data[DDRD] : avr->data[PORTB] & avr->data[DDRB];
  return data >> (pin % 8) & 1;
}

static enum contact contact_of(int channel) {
  const bool positive = high(2 + channel), negative = high(4 + channel), ground = !high(6 + channel);
  if (positive + negative + ground > 1) ++overlaps;
  if (hardware[channel].contact_welded) return POSITIVE;  // and keeps the ground contact from closing
  if (hardware[channel].ground_broken && ground) return OPEN;
  return ground ? GROUND : positive ? POSITIVE : negative ? NEGATIVE : OPEN;
}

static void note_gap(uint64_t since) {
  if (since != 0 && avr->cycle - since < shortest_gap) shortest_gap = avr->cycle - since;
}

static void pins_changed(struct avr_irq_t* irq, uint32_t value, void* parameter) {
  (void)irq, (void)value, (void)parameter;
  for (int channel = 0; channel < CHANNELS; ++channel) {
    const enum contact before = contacts[channel], after = contact_of(channel);
    contacts[channel] = after;
    if (before == after) continue;
    if (before == POSITIVE || before == NEGATIVE) source_opened[channel] = avr->cycle;
    if (before == GROUND) ground_opened[channel] = avr->cycle;
    if (after == GROUND) note_gap(source_opened[channel]);
    if (after == POSITIVE || after == NEGATIVE) note_gap(ground_opened[channel]);
  }
}

// As in the AVR, where the high byte waits in a register of its own until the low one is written.
static void compare_written(struct avr_irq_t* irq, uint32_t low_byte, void* parameter) {
  (void)irq;
  const int channel = (int)(intptr_t)parameter;
  compare_values[channel] = low_byte | avr->data[(channel == 0 ? OCR1A : OCR1B) + 1] << 8;
}

static double set_point_v(int channel) {
  const uint8_t connected = channel == 0 ? 0x80 : 0x20;
  return high(8) && avr->data[TCCR1A] & connected ? compare_values[channel] * hardware[channel].set_point_gain : 0.0;
}

static void raise_analogue(int input, double full_scale_share) {
  const uint32_t millivolts = fmin(5000.0, 5000.0 * full_scale_share);
  avr_raise_irq(analogue_irqs + input, millivolts);
}

static void set_interlock(void) {
  static const int bits[2] = {4, 3};  // pins 12 and 11
  const int value = interlock_open[0] << bits[0] | interlock_open[1] << bits[1];
  avr_ioport_external_t pull = {.name = 'B', .mask = 1 << bits[0] | 1 << bits[1], .value = value};
  avr_ioctl(avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('B'), &pull);
  for (int i = 0; i < 2; ++i) {
    avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), bits[i]), interlock_open[i]);
  }
}

// Auxiliary contacts, low while the ground contact is closed in truth: pins A4 and A5.
static void set_contact(int channel) {
  avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('C'), 4 + channel), contacts[channel] != GROUND);
}

static void damage_eeprom(void) {
  uint8_t byte = 0;
  avr_eeprom_desc_t where = {.ee = &byte, .offset = 1, .size = 1};
  avr_ioctl(avr, AVR_IOCTL_EEPROM_GET, &where);
  byte ^= 0x10;
  where.ee = &byte;
  avr_ioctl(avr, AVR_IOCTL_EEPROM_SET, &where);
}

static void tick(void) {
  // Pins 2 and 3 are outputs; after any reset simavr polls them for external interrupts, at most of its time.
  avr_extint_set_strict_lvl_trig(avr, EXTINT_IRQ_OUT_INT0, 0);
  avr_extint_set_strict_lvl_trig(avr, EXTINT_IRQ_OUT_INT1, 0);
  bool is_live = false;
  for (int channel = 0; channel < CHANNELS; ++channel) {
    contacts[channel] = contact_of(channel);
    muscle_step(&muscles[channel], 1e-3, contacts[channel], set_point_v(channel));
    const double volts = fabs(muscles[channel].voltage_v);
    peaks_v[channel] = fmax(peaks_v[channel], volts);
    is_live |= volts > LIVE_V || contacts[channel] != GROUND;
    const struct hardware* own = &hardware[channel];
    const double said_v = own->stuck_v < 0.0 ? volts * own->monitor_gain : own->stuck_v;
    raise_analogue(channel, said_v / 10000.0);
    set_contact(channel);
    raise_analogue(CHANNELS + channel, muscles[channel].current_a / 1e-3);
  }
  if (is_live != live) {
    live = is_live;
    printf("%s %.4f\n", live ? "live" : "dead", now_s());
    fflush(stdout);
  }
}

static void uart_sent(struct avr_irq_t* irq, uint32_t value, void* parameter) {
  (void)irq, (void)parameter;
  static bool within_line, skipping;
  if (!within_line && boot_lost && value == '!') skipping = true;
  within_line = value != '\n';
  if (!skipping && transmitted_count < sizeof(transmitted)) transmitted[transmitted_count++] = value;
  if (skipping && value == '\n') skipping = boot_lost = false;
}

static void uart_flow(struct avr_irq_t* irq, uint32_t value, void* parameter) {
  (void)irq, (void)value;
  uart_full = parameter != NULL;
}

static void feed_uart(void) {
  static uint64_t next_cycle;
  if (received_count == 0 || uart_full || avr->cycle < next_cycle) return;
  next_cycle = avr->cycle + BYTE_CYCLES;
  avr_raise_irq(uart_irqs + UART_IRQ_INPUT, (uint8_t)received[0]);
  memmove(received, received + 1, --received_count);
}

static void reset(void) {
  avr_reset(avr);
  memset(compare_values, 0, sizeof(compare_values));
  avr_regbit_set(avr, avr->reset_flags.extrf);
  received_count = transmitted_count = 0;
  set_interlock();
}

static void exchange(void) {
  const bool present = port_host_present(&port);
  if (present && !host_present) reset();  // opening the port toggles DTR
  host_present = present;
  const size_t count = port_read(&port, received + received_count, sizeof(received) - received_count);
  if (noise && count > 3) {
    received[received_count + count - 3] ^= 1;
    noise = false;
  }
  if (tracing) trace_commands(received + received_count, count, now_s());
  if (!deaf) received_count += count;
  const size_t kept = transmitted_count / 2;
  if (truncate_next && transmitted_count > 2 && transmitted[kept - 1] != '\n') {  // not between two lines
    transmitted[kept] = '\n';
    transmitted_count = kept + 1;
    truncate_next = false;
  }
  if (host_present && !silent) port_write(&port, transmitted, transmitted_count);
  transmitted_count = 0;
}

static void run_until(uint64_t target) {
  static uint64_t next_tick;
  while (avr->cycle < target) {
    avr_run(avr);
    feed_uart();
    if (avr->cycle >= next_tick) {
      next_tick = avr->cycle + TICK_CYCLES;
      tick();
    }
  }
}

static void recover(void) {
  silent = deaf = noise = truncate_next = boot_lost = false;
  interlock_open[0] = interlock_open[1] = false;
  hardware[0] = hardware[1] = WHOLE;
  broken = 0;
  set_interlock();
  muscles[0].short_ohm = muscles[1].short_ohm = HUGE_VAL;
}

static void hang(void) {
  avr->flash[HANG_ADDRESS] = 0xFF;  // rjmp to itself
  avr->flash[HANG_ADDRESS + 1] = 0xCF;
  avr->pc = HANG_ADDRESS;
}

static void send_garbage(void) {
  char data[41];
  for (int i = 0; i < 40; ++i) data[i] = rand();
  data[40] = '\n';
  port_write(&port, data, sizeof(data));
}

static void print_output(void) {
  printf("output %.0f %.0f %d %d %.0f %.0f\n", muscles[0].voltage_v, muscles[1].voltage_v, contacts[0] == GROUND,
         contacts[1] == GROUND, peaks_v[0], peaks_v[1]);
}

static void bounce(void) {
  interlock_open[0] = interlock_open[1] = true;
  set_interlock();
  run_until(avr->cycle + 2 * TICK_CYCLES - TICK_CYCLES / 10);  // of 2 ms to the cycle, three ticks might see both ends
  interlock_open[0] = interlock_open[1] = false;
  set_interlock();
}

// Twice: the sketch may be just about to write the register as it read it before.
static void stop_conversion(void) {
  for (int time = 0; time < 2; ++time) {
    avr->data[ADCSRA] &= ~(1 << ADIE);
    run_until(avr->cycle + BYTE_CYCLES);
  }
}

static bool obey(const char* word) {
  struct hardware* own = &hardware[broken];
  if (!strcmp(word, "quit")) return false;
  if (!strcmp(word, "silence")) silent = true;
  else if (!strcmp(word, "deaf")) deaf = true;
  else if (!strcmp(word, "noise")) noise = true;
  else if (!strcmp(word, "truncate")) truncate_next = true;
  else if (!strcmp(word, "interlock")) interlock_open[0] = interlock_open[1] = true, set_interlock();
  else if (!strcmp(word, "bounce")) bounce();
  else if (!strcmp(word, "interlock_a")) interlock_open[0] = true, set_interlock();
  else if (!strcmp(word, "interlock_b")) interlock_open[1] = true, set_interlock();
  else if (!strcmp(word, "lower")) broken = 1;
  else if (!strcmp(word, "weld")) own->contact_welded = true;
  else if (!strcmp(word, "unground")) own->ground_broken = true;
  else if (!strcmp(word, "tickless")) avr->data[TIMSK2] = 0;
  else if (!strcmp(word, "blind")) own->monitor_gain = 0.0;
  else if (!strcmp(word, "third")) own->monitor_gain = 1.0 / 3.0;
  else if (!strcmp(word, "stick")) own->stuck_v = fabs(muscles[broken].voltage_v);
  else if (!strcmp(word, "unconverted")) stop_conversion();
  else if (!strcmp(word, "leak")) muscles[broken].short_ohm = 1e8;
  else if (!strcmp(word, "damage")) damage_eeprom();
  else if (!strcmp(word, "miscalibrate")) own->set_point_gain = 0.97, own->monitor_gain = 1.04;
  else if (!strcmp(word, "overcurrent")) muscles[broken].short_ohm = 2e6;
  else if (!strcmp(word, "recover")) recover();
  else if (!strcmp(word, "reset")) reset();
  else if (!strcmp(word, "mute_reset")) boot_lost = true, reset();
  else if (!strcmp(word, "stuck")) hang();
  else if (!strcmp(word, "garbage")) send_garbage();
  else if (!strcmp(word, "unplug")) port_unplug(&port);
  else if (!strcmp(word, "replug")) port_unplug(&port), port_plug(&port);
  else if (!strcmp(word, "trace")) tracing = true;
  else if (!strcmp(word, "output")) print_output();
  else if (!strcmp(word, "contacts")) printf("contacts %u %.0f\n", overlaps, shortest_gap / (FREQUENCY_HZ * 1e-6));
  else printf("unknown input %s\n", word);
  fflush(stdout);
  return true;
}

static bool obey_input(void) {
  static char line[256];
  static size_t length;
  struct pollfd input = {.fd = 0, .events = POLLIN};
  while (poll(&input, 1, 0) > 0) {
    if (read(0, line + length, 1) != 1) return false;
    if (line[length] != '\n') {
      length = (length + 1) % (sizeof(line) - 1);
      continue;
    }
    line[length] = '\0';
    length = 0;
    if (!obey(line)) return false;
  }
  return true;
}

static void sleep_callback(avr_t* self, avr_cycle_count_t cycles) {
  (void)self, (void)cycles;  // pace() keeps real time
}

static void start(const char* path) {
  elf_firmware_t firmware = {0};
  avr = avr_make_mcu_by_name("atmega328p");
  if (!avr || elf_read_firmware(path, &firmware) != 0) {
    fprintf(stderr, "%s cannot be read as a sketch for the ATmega328P: build it with make.\n", path);
    exit(1);
  }
  avr_init(avr);
  avr_load_firmware(avr, &firmware);
  avr->frequency = FREQUENCY_HZ;
  avr->vcc = avr->avcc = avr->aref = 5000;
  avr->sleep = sleep_callback;
  uint32_t flags = 0;
  avr_ioctl(avr, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
  flags &= ~(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POOL_SLEEP);
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  uart_irqs = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), 0);
  analogue_irqs = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0);
  avr_irq_register_notify(uart_irqs + UART_IRQ_OUTPUT, uart_sent, NULL);
  avr_irq_register_notify(uart_irqs + UART_IRQ_OUT_XOFF, uart_flow, avr);
  avr_irq_register_notify(uart_irqs + UART_IRQ_OUT_XON, uart_flow, NULL);
  for (int channel = 0; channel < CHANNELS; ++channel) {
    avr_irq_t* written = avr_iomem_getirq(avr, channel == 0 ? OCR1A : OCR1B, NULL, AVR_IOMEM_IRQ_ALL);
    avr_irq_register_notify(written, compare_written, (void*)(intptr_t)channel);
  }
  for (int pin = 2; pin < 8; ++pin) {
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), pin), pins_changed, NULL);
  }
}

int main(int count, char** arguments) {
  if (count != 2 && count != 3) {
    fprintf(stderr, "usage: simulate hasel_supply.elf [capacitance of each muscle, nF]\n");
    return 1;
  }
  muscles[0].capacitance_f = muscles[1].capacitance_f = (count == 3 ? atof(arguments[2]) : 0.5) * 1e-9;
  start(arguments[1]);
  recover();
  port_plug(&port);
  double epoch_s = now_s();
  uint64_t epoch_cycle = avr->cycle;
  while (obey_input()) {
    exchange();
    uint64_t target = epoch_cycle + (uint64_t)((now_s() - epoch_s) * FREQUENCY_HZ);
    if (target > avr->cycle + LATE_CYCLES) {
      printf("late %.3f\n", (double)(target - avr->cycle) / FREQUENCY_HZ);
      fflush(stdout);
    }
    if (target > avr->cycle + MOST_LAG_CYCLES) {
      epoch_s = now_s();
      epoch_cycle = avr->cycle;
      target = avr->cycle + TICK_CYCLES;
    }
    run_until(target);
    exchange();
    struct pollfd ready[2] = {{.fd = 0, .events = POLLIN}, {.fd = host_present ? port.descriptor : -1, .events = POLLIN}};
    poll(ready, 2, 1);
  }
  port_unplug(&port);
  return 0;
}
