// Fontconfig keeps what it learned of the fonts until the process ends; LeakSanitizer would call it
// lost. Nothing of ours is named here.

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GNOMON_LEAKS_ARE_CHECKED
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define GNOMON_LEAKS_ARE_CHECKED
#endif

#ifdef GNOMON_LEAKS_ARE_CHECKED
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the sanitizer's own name
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig\nleak:libpango\n";
}
#endif
