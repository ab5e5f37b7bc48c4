// Library preloaded into the program that counts its allocations. Each process appends a line with its totals to
// the file named by SPREKK_ALLOCATIONS; MPI starts further processes.
#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

std::atomic<long long> n_calls{0}, n_bytes{0};

void* counted(void* made) {
  ++n_calls;
  n_bytes += static_cast<long long>(malloc_usable_size(made));
  return made;
}

__attribute__((destructor)) void tell() {
  const char* name = std::getenv("SPREKK_ALLOCATIONS");
  std::FILE* file = name ? std::fopen(name, "a") : nullptr;
  if (!file) return;
  std::fprintf(file, "{\"calls\": %lld, \"bytes\": %lld}\n", n_calls.load(), n_bytes.load());
  std::fclose(file);
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) { return counted(__libc_malloc(size)); }
void* calloc(std::size_t n, std::size_t size) { return counted(__libc_calloc(n, size)); }
void* realloc(void* old, std::size_t size) { return counted(__libc_realloc(old, size)); }
void* memalign(std::size_t alignment, std::size_t size) { return counted(__libc_memalign(alignment, size)); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** made, std::size_t alignment, std::size_t size) {
  *made = memalign(alignment, size);
  return *made ? 0 : ENOMEM;
}
}
