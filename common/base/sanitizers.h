/// Which sanitizers this is built with: GCC and Clang say it each in its own way.
///
/// PALPATE_UNDER_ASAN, PALPATE_UNDER_TSAN: 1 under AddressSanitizer, under ThreadSanitizer, else 0.
#pragma once

#if defined(__has_feature)
#define PALPATE_HAS_FEATURE(feature) __has_feature(feature)
#else
#define PALPATE_HAS_FEATURE(feature) 0
#endif

#if defined(__SANITIZE_ADDRESS__) || PALPATE_HAS_FEATURE(address_sanitizer)
#define PALPATE_UNDER_ASAN 1
#else
#define PALPATE_UNDER_ASAN 0
#endif

#if defined(__SANITIZE_THREAD__) || PALPATE_HAS_FEATURE(thread_sanitizer)
#define PALPATE_UNDER_TSAN 1
#else
#define PALPATE_UNDER_TSAN 0
#endif
