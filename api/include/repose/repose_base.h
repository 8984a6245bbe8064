/**
 * @file repose_base.h
 * What all of repose.h rests on, which includes it: versions, statuses, handles, and the texts of errors.
 */
#ifndef REPOSE_REPOSE_BASE_H
#define REPOSE_REPOSE_BASE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(REPOSE_BUILDS_LIBRARY) && defined(__GNUC__)
#define REPOSE_API __attribute__((visibility("default")))
#else
#define REPOSE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The version of this header: 1000000 major + 1000 minor + patch. */
#define REPOSE_VERSION 1000
/** The version of all structs of this header. */
#define REPOSE_STRUCT_VERSION 1

/** What a call came to. The values of the first group are the exit codes of the command `repose`. */
typedef int32_t repose_status;
enum {
  REPOSE_OK = 0,
  REPOSE_ERROR_USAGE = 64,        /**< wrong arguments, or a call that does not go with this scene */
  REPOSE_ERROR_SCENE = 65,        /**< a scene, or geometry that it names, is wrong */
  REPOSE_ERROR_NO_INPUT = 66,     /**< an input file does not exist or cannot be read */
  REPOSE_ERROR_PHYSICS = 70,      /**< the physics gave out; the state is that of the last step that was made */
  REPOSE_ERROR_INTERNAL = 71,     /**< a bug in Repose */
  REPOSE_ERROR_CANNOT_WRITE = 73, /**< the output cannot be written */
  REPOSE_ERROR_IO = 74,           /**< reading or writing failed midway, or bytes are damaged */
  REPOSE_ERROR_MEMORY = 78,       /**< needs more memory than there is, or than may be used */

  REPOSE_ERROR_HANDLE = 100,   /**< a handle that is null, was destroyed, or is of another kind */
  REPOSE_ERROR_ARGUMENT = 101, /**< a null pointer, an index or a size that cannot be */
  REPOSE_ERROR_VERSION = 102,  /**< a struct of a version, or a size, that this library does not know */
  REPOSE_ERROR_BUSY = 103,     /**< another call on this engine is under way */
  REPOSE_ERROR_STALE = 104     /**< a view whose numbers may lie elsewhere by now */
};

/** A scene being put together. Handles are numbers, no addresses; value 0 is none. */
typedef struct repose_scene {
  uint64_t value; /**< 0: none */
} repose_scene;
/** A simulation. */
typedef struct repose_engine {
  uint64_t value; /**< 0: none */
} repose_engine;
/** A copy of the particles at one moment. */
typedef struct repose_points {
  uint64_t value; /**< 0: none */
} repose_points;

/** The material at one moment, as a box of voxels. */
typedef struct repose_volume {
  uint64_t value; /**< 0: none */
} repose_volume;

/** The version of the library, as REPOSE_VERSION. */
REPOSE_API uint32_t repose_version(void);

/** "no such handle" for REPOSE_ERROR_HANDLE, and so on; valid for ever. */
REPOSE_API const char* repose_status_text(repose_status status);

/**
 * @name Of the last call of this thread that did not return REPOSE_OK
 * The message names what is wrong and what would be right, several lines where several things are wrong with a
 * scene; the key is a path of the scene ("grid.spacing"), a file, or the name of an argument; the place is
 * "file:line:column" where a scene's text has one. Up to `capacity` bytes are copied, always ended by a zero
 * where capacity > 0. Returns the length of the whole text without the zero, so that a capacity of 0 asks for
 * it.
 * @{
 */
/** What it returned. */
REPOSE_API repose_status repose_error_status(void);
/** What it says. */
REPOSE_API size_t repose_error_message(char* buffer, size_t capacity);
/** What it is about. */
REPOSE_API size_t repose_error_key(char* buffer, size_t capacity);
/** Where in a text that is. */
REPOSE_API size_t repose_error_place(char* buffer, size_t capacity);
/** @} */

/** `bytes` is a multiple of `alignment`, 64. Null: there are none, and the call that asked answers MEMORY. */
typedef void* (*repose_allocate_fn)(void* user, size_t bytes, size_t alignment);
/** What a repose_allocate_fn returned, with the numbers that it was called with. */
typedef void (*repose_release_fn)(void* user, void* memory, size_t bytes, size_t alignment);

/**
 * Where large arrays come from: the numbers of particles, nodes and solvers, next to all that grows with a
 * scene. Lists, trees of blocks, meshes and shapes come from malloc as ever. The functions are called from any
 * thread, also at once, and must not call the library.
 */
typedef struct repose_allocator {
  uint32_t size;               /**< of the struct, bytes */
  uint32_t version;            /**< REPOSE_STRUCT_VERSION */
  repose_allocate_fn allocate; /**< not null */
  repose_release_fn release;   /**< not null */
  void* user;                  /**< what both are called with; valid as long as what they gave is held */
} repose_allocator;

/**
 * For the whole process, from now on; arrays that lie elsewhere go back to those who gave them. Null: malloc
 * again. Call it before engines are made, or a new allocator holds a part of them. Errors: ARGUMENT, a function
 * is null; VERSION.
 */
REPOSE_API repose_status repose_set_allocator(const repose_allocator* allocator);

/** Defines repose_NAME_init(), a struct that knows its size and version and is otherwise 0; then `more`. */
#define REPOSE_DEFINE_INIT_WITH(type, more) \
  static inline type type##_init(void) {    \
    type made;                              \
    memset(&made, 0, sizeof made);          \
    made.size = (uint32_t)sizeof made;      \
    made.version = REPOSE_STRUCT_VERSION;   \
    more return made;                       \
  }
/** The same without more. */
#define REPOSE_DEFINE_INIT(type) REPOSE_DEFINE_INIT_WITH(type, )
REPOSE_DEFINE_INIT(repose_allocator)

#ifdef __cplusplus
}
#endif

#endif
