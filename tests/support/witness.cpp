// A library to preload (LD_PRELOAD) into the program under test. When the program ends, it writes to the file
// that HWSIM_WITNESS names: the shared libraries, the files opened, and how often memory was allocated. Tests
// assert these causes of a slow start; a time would be the machine's.
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>

#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* old, std::size_t bytes);
}

namespace {

// Plain memory: whatever is called here must not allocate.
char report[1 << 20];
std::atomic<std::size_t> used{0};
std::atomic<std::size_t> allocations{0}, allocated_bytes{0};

void note(const char* what, const char* path) {
  const std::size_t size = std::strlen(what) + std::strlen(path) + 2;
  const std::size_t begin = used.fetch_add(size);
  if (begin + size < sizeof report) std::snprintf(report + begin, size + 1, "%s %s\n", what, path);
}

void count(std::size_t bytes) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  allocated_bytes.fetch_add(bytes, std::memory_order_relaxed);
}

int note_library(dl_phdr_info* library, std::size_t, void* when) {
  if (library->dlpi_name[0] != '\0') note(static_cast<const char*>(when), library->dlpi_name);
  return 0;
}

void note_libraries(const char* when) { dl_iterate_phdr(note_library, const_cast<char*>(when)); }

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool writes(int flags) { return (flags & O_ACCMODE) != O_RDONLY; }
bool writes(const char* mode) { return std::strpbrk(mode, "wa+") != nullptr; }

int open_noted(const char* name, const char* path, int flags, mode_t mode) {
  note(writes(flags) ? "write" : "read", path);
  return next<int(const char*, int, ...)>(name)(path, flags, mode);
}

std::FILE* fopen_noted(const char* name, const char* path, const char* mode) {
  note(writes(mode) ? "write" : "read", path);
  return next<std::FILE*(const char*, const char*)>(name)(path, mode);
}

mode_t mode_of(int flags, std::va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? static_cast<mode_t>(va_arg(more, int)) : 0;
}

__attribute__((constructor)) void begin() { note_libraries("linked"); }

__attribute__((destructor)) void end() {
  note_libraries("loaded");
  const char* path = std::getenv("HWSIM_WITNESS");
  if (path == nullptr) return;
  const std::size_t counted = allocations, bytes = allocated_bytes;
  std::FILE* out = next<std::FILE*(const char*, const char*)>("fopen")(path, "w");
  if (out == nullptr) return;
  std::fwrite(report, 1, used < sizeof report ? used.load() : 0, out);
  std::fprintf(out, "allocations %zu\nallocated_bytes %zu\n", counted, bytes);
  std::fclose(out);
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) noexcept {
  count(bytes);
  return __libc_malloc(bytes);
}
void* calloc(std::size_t elements, std::size_t bytes) noexcept {
  count(elements * bytes);
  return __libc_calloc(elements, bytes);
}
void* realloc(void* old, std::size_t bytes) noexcept {
  count(bytes);
  return __libc_realloc(old, bytes);
}

int open(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_noted("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_noted("open64", path, flags, mode);
}
std::FILE* fopen(const char* path, const char* mode) { return fopen_noted("fopen", path, mode); }
std::FILE* fopen64(const char* path, const char* mode) { return fopen_noted("fopen64", path, mode); }

}  // extern "C"
