/* Repose tests: the Nth call of a kind fails, as it does on a full disk or without memory. Loaded before all other
 * libraries (LD_PRELOAD). FAIL_NTH="KIND N" with KIND write, sync, rename, create or allocate; with N 0 none fails.
 * FAIL_NTH_COUNT names a file that then tells how many calls there were. FAIL_NTH_FOLDER: of files, only those whose
 * path has it. KIND site: the first allocation fails that is asked for from the place N, which stands for the callers;
 * the file then lists all places. Calls count from where main begins. An allocation that fails lets all later ones
 * through; those of libblosc, which uses what it gets without a look, never fail. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WRITE, SYNC, RENAME, CREATE, ALLOCATE, SITE, KINDS };
static const char* const kNames[KINDS] = {"write", "sync", "rename", "create", "allocate", "site"};

static int chosen = -1;
static long fails = 0;
static char folder[1024], count_path[1024];
static atomic_long counted;
static atomic_int ready;

static void* (*real_malloc)(size_t);
static void* (*real_calloc)(size_t, size_t);
static void* (*real_realloc)(void*, size_t);
static void* (*real_aligned_alloc)(size_t, size_t);
static int (*real_posix_memalign)(void**, size_t, size_t);

/* Places that asked for memory, by a number that is the same in every run. */
enum { SITES = 1 << 16, DEPTH = 4 };
static atomic_long sites[SITES], seen[SITES]; /* seen: the same by addresses of this run, which is quicker to tell */

/* dlsym itself may ask for a little. */
static char early[65536];
static size_t early_used;
static void* early_room(size_t bytes) {
  void* const room = early + early_used;
  early_used += (bytes + 15) / 16 * 16;
  return early_used <= sizeof early ? room : NULL;
}
static int is_early(const void* p) { return (const char*)p >= early && (const char*)p < early + sizeof early; }

/* Other libraries begin, and allocate, before this one. */
static void find_allocators(void) {
  static atomic_int looking;
  if (real_malloc != NULL || atomic_exchange(&looking, 1) != 0) return;
  real_calloc = dlsym(RTLD_NEXT, "calloc");
  real_realloc = dlsym(RTLD_NEXT, "realloc");
  real_aligned_alloc = dlsym(RTLD_NEXT, "aligned_alloc");
  real_posix_memalign = dlsym(RTLD_NEXT, "posix_memalign");
  real_malloc = dlsym(RTLD_NEXT, "malloc");
}

__attribute__((constructor)) static void begin(void) {
  find_allocators();
  const char* const what = getenv("FAIL_NTH");
  char name[32] = "";
  if (what != NULL && sscanf(what, "%31s %ld", name, &fails) == 2) {
    for (int k = 0; k < KINDS; ++k) {
      if (strcmp(name, kNames[k]) == 0) chosen = k;
    }
  }
  const char* const within = getenv("FAIL_NTH_FOLDER");
  const char* const to = getenv("FAIL_NTH_COUNT");
  if (within != NULL) snprintf(folder, sizeof folder, "%s", within);
  if (to != NULL) snprintf(count_path, sizeof count_path, "%s", to);
  unsetenv("LD_PRELOAD"); /* programs that this one starts do not fail */
}

/* What libraries' own objects ask for before main, nobody can answer for. */
static int (*real_main)(int, char**, char**);
static int begin_main(int count, char** words, char** environment) {
  atomic_store(&ready, 1);
  return real_main(count, words, environment);
}
int __libc_start_main(int (*main)(int, char**, char**), int count, char** words, void (*init)(void), void (*fini)(void),
                      void (*linker_fini)(void), void* stack) {
  real_main = main;
  int (*start)(int (*)(int, char**, char**), int, char**, void (*)(void), void (*)(void), void (*)(void), void*) =
      (__typeof__(start))dlsym(RTLD_NEXT, "__libc_start_main");
  return start(begin_main, count, words, init, fini, linker_fini, stack);
}

__attribute__((destructor)) static void end(void) {
  atomic_store(&ready, 0);
  if (count_path[0] == 0) return;
  FILE* const file = fopen(count_path, "w");
  if (file == NULL) return;
  if (chosen == SITE) {
    for (int k = 0; k < SITES; ++k) {
      if (atomic_load(&sites[k]) != 0) fprintf(file, "%ld\n", atomic_load(&sites[k]));
    }
  } else {
    fprintf(file, "%ld\n", atomic_load(&counted));
  }
  fclose(file);
}

static int is_of_blosc(const void* caller) {
  Dl_info info;
  return dladdr(caller, &info) != 0 && info.dli_fname != NULL && strstr(info.dli_fname, "libblosc") != NULL;
}

static int fail_now(int kind) {
  if (kind != chosen || atomic_load(&ready) == 0) return 0;
  return atomic_fetch_add(&counted, 1) + 1 == fails;
}

/* Whether a number comes into a table for the first time. */
static int is_new(atomic_long* table, long number) {
  for (unsigned long at = (unsigned long)number % SITES;; at = (at + 1) % SITES) {
    long there = 0;
    if (atomic_compare_exchange_strong(&table[at], &there, number)) return 1;
    if (there == number) return 0;
  }
}

static long mix(long place, unsigned long more) {
  return (long)(((unsigned long)place ^ more) * 1099511628211UL) | 1;
}

/* To tell who calls may itself ask for memory. */
static int fails_by_place(void) {
  static _Thread_local int within;
  static atomic_int done;
  if (within || atomic_load(&done) || atomic_load(&ready) == 0) return 0;
  within = 1;
  void* callers[DEPTH + 3];
  const int depth = backtrace(callers, DEPTH + 3);
  long here = 1, place = 1;
  for (int k = 3; k < depth; ++k) here = mix(here, (unsigned long)callers[k]); /* beyond this, its caller and malloc */
  int fail = 0;
  if (is_new(seen, here)) {
    for (int k = 3; k < depth; ++k) {
      Dl_info info;
      place = mix(place, (unsigned long)callers[k] - (dladdr(callers[k], &info) != 0 ? (unsigned long)info.dli_fbase : 0));
    }
    fail = is_new(sites, place) && place == fails;
    if (fail) atomic_store(&done, 1);
  }
  within = 0;
  return fail;
}

static int allocation_fails(const void* caller) {
  if ((chosen != ALLOCATE && chosen != SITE) || is_of_blosc(caller)) return 0;
  return chosen == SITE ? fails_by_place() : fail_now(ALLOCATE);
}

static int within_folder(int descriptor) {
  if (folder[0] == 0) return 1;
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return 0;
  path[length] = 0;
  return strstr(path, folder) != NULL;
}

/* The function that this one stands before. */
#define REAL(function)                    \
  static __typeof__(&function) real;      \
  if (real == NULL) real = (__typeof__(&function))dlsym(RTLD_NEXT, #function)

ssize_t write(int descriptor, const void* data, size_t bytes) {
  REAL(write);
  if (chosen == WRITE && within_folder(descriptor) && fail_now(WRITE)) return errno = ENOSPC, -1;
  return real(descriptor, data, bytes);
}
ssize_t pwrite(int descriptor, const void* data, size_t bytes, off_t offset) {
  REAL(pwrite);
  if (chosen == WRITE && within_folder(descriptor) && fail_now(WRITE)) {
    if (bytes > 1) real(descriptor, data, bytes / 2, offset); /* a disk that fills takes a part */
    return errno = ENOSPC, -1;
  }
  return real(descriptor, data, bytes, offset);
}
ssize_t pwrite64(int descriptor, const void* data, size_t bytes, off_t offset) {
  return pwrite(descriptor, data, bytes, offset);
}
int fsync(int descriptor) {
  REAL(fsync);
  if (chosen == SYNC && within_folder(descriptor) && fail_now(SYNC)) return errno = EIO, -1;
  return real(descriptor);
}
int rename(const char* from, const char* to) {
  REAL(rename);
  if (chosen == RENAME && strstr(to, folder) != NULL && fail_now(RENAME)) return errno = EIO, -1;
  return real(from, to);
}
int open(const char* path, int flags, ...) {
  REAL(open);
  va_list rest;
  va_start(rest, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
  va_end(rest);
  if (chosen == CREATE && (flags & O_CREAT) != 0 && strstr(path, folder) != NULL && fail_now(CREATE))
    return errno = EDQUOT, -1;
  return real(path, flags, mode);
}

void* malloc(size_t bytes) {
  find_allocators();
  if (real_malloc == NULL) return early_room(bytes);
  return allocation_fails(__builtin_return_address(0)) ? (errno = ENOMEM, NULL) : real_malloc(bytes);
}
void* calloc(size_t count, size_t bytes) {
  find_allocators();
  if (real_malloc == NULL) return early_room(count * bytes);
  return allocation_fails(__builtin_return_address(0)) ? (errno = ENOMEM, NULL) : real_calloc(count, bytes);
}
void* realloc(void* old, size_t bytes) {
  find_allocators();
  if (real_malloc == NULL || is_early(old)) {
    void* const room = real_malloc == NULL ? early_room(bytes) : real_malloc(bytes);
    if (old != NULL && room != NULL) memcpy(room, old, bytes);
    return room;
  }
  return allocation_fails(__builtin_return_address(0)) ? (errno = ENOMEM, NULL) : real_realloc(old, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
  find_allocators();
  return allocation_fails(__builtin_return_address(0)) ? (errno = ENOMEM, NULL) : real_aligned_alloc(alignment, bytes);
}
int posix_memalign(void** room, size_t alignment, size_t bytes) {
  find_allocators();
  return allocation_fails(__builtin_return_address(0)) ? ENOMEM : real_posix_memalign(room, alignment, bytes);
}
void free(void* room) {
  REAL(free);
  if (room != NULL && !is_early(room)) real(room);
}
