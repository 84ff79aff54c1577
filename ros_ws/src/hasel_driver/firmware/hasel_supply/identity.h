// What this firmware calls itself.
#pragma once

constexpr char IDENTITY[] = "hasel-supply 2.0 protocol 2";
