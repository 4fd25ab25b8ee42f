#pragma once

/// \file
/// Visibility of the library's symbols: hidden unless marked CAROM_API.

/// \def CAROM_API
/// Marks what can be linked to from outside.

#if defined(CAROM_STATIC)
#define CAROM_API
#elif defined(_WIN32)
#if defined(CAROM_BUILDING)
#define CAROM_API __declspec(dllexport)
#else
#define CAROM_API __declspec(dllimport)
#endif
#else
#define CAROM_API __attribute__((visibility("default")))
#endif
