/**
 * @file repose.h
 * Repose for programs that embed it: sand by the Material Point Method. This header is the only binary
 * interface of the library; it is C99, and names no other library. repose.hpp is a C++17 wrapper over it,
 * docs/embedding.md the guide.
 *
 * Units are SI (m, s, kg, N, Pa), angles degrees. Positions are in the frame of the scene, whose "up" says
 * whether y or z points up.
 *
 * Errors. Functions return a repose_status, REPOSE_OK or what kind of refusal it is; the message, and the key
 * or the file that it is about, are kept per thread (repose_error_message). No exception leaves the library. A
 * handle that was destroyed, or never made, is answered with REPOSE_ERROR_HANDLE.
 *
 * Structs begin with their size and version. Make them by the inline function of their name
 * (repose_report_init), which sets both and all else to its default; REPOSE_ERROR_VERSION answers a struct of
 * another version.
 *
 * Threads. Any thread may call any function. An engine does one thing at a time: while a call is under way on
 * it, others on the same engine, also those from a callback, are answered with REPOSE_ERROR_BUSY, all but
 * repose_interrupt, repose_engine_destroy and repose_view_check. Calls on different engines run side by side.
 * Callbacks are called on the thread of the call that they belong to.
 *
 * Memory. The library copies what it is given before a call returns. Pointers that it hands out belong to it;
 * each says how long it is valid.
 */
#ifndef REPOSE_REPOSE_H
#define REPOSE_REPOSE_H

#include "repose_base.h"
#include "repose_reading.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Scenes ------------------------------------------------------------------------------------------------------
 */

enum { REPOSE_QUALITY_STANDARD = 0, REPOSE_QUALITY_DRAFT = 1, REPOSE_QUALITY_REFERENCE = 2 };

/** How scenes are read. */
typedef struct repose_scene_options {
  uint32_t size;               /**< of the struct, bytes */
  uint32_t version;            /**< REPOSE_STRUCT_VERSION */
  int32_t quality;             /**< as the command's --quality */
  int32_t allow_outside_paths; /**< not 0: meshes may lie outside the scene's folder */
} repose_scene_options;
REPOSE_DEFINE_INIT(repose_scene_options)

/**
 * Reads a scene file. `options` may be null.
 * Errors: NO_INPUT, SCENE.
 */
REPOSE_API repose_status repose_scene_from_file(const char* path, const repose_scene_options* options,
                                                repose_scene* scene);

/**
 * Reads a scene from `length` bytes of text; relative paths in it start at `folder` ("." where null), and
 * errors call it `name` ("scene" where null). Error: SCENE.
 */
REPOSE_API repose_status repose_scene_from_text(const char* text, size_t length, const char* name,
                                                const char* folder, const repose_scene_options* options,
                                                repose_scene* scene);

/** A scene without a key, to be filled by repose_scene_set. */
REPOSE_API repose_status repose_scene_empty(const char* folder, const repose_scene_options* options,
                                            repose_scene* scene);

/**
 * Sets a key, as the command's --set: `key` is a path ("grid.spacing", "colliders.glass.friction",
 * "bodies[0]"), `value` JSON, else taken as text. It is looked at when repose_scene_check or
 * repose_engine_create reads the scene. Error: ARGUMENT.
 */
REPOSE_API repose_status repose_scene_set(repose_scene scene, const char* key, const char* value);

/** Reads the scene with all that was set. Error: SCENE, with a line for each thing that is wrong. */
REPOSE_API repose_status repose_scene_check(repose_scene scene);

/**
 * Says that the host will move a rigid collider (repose_move_collider), or deform one that is a mesh
 * (repose_deform_collider) `rate` times a second: usually the scene's frames per second, or a multiple of it.
 * Such a collider has no "motion" and no "frames" of its own. Errors come with repose_engine_create.
 */
REPOSE_API repose_status repose_scene_lead_pose(repose_scene scene, const char* collider);
/** The same of one that deforms, with `rate` in 1/s. Error: ARGUMENT where it is not above 0. */
REPOSE_API repose_status repose_scene_lead_mesh(repose_scene scene, const char* collider, double rate);

/**
 * Says which program parses the VDB files that the scene names, and what it may take; engines of the scene keep
 * to it. They are never parsed within the process of the host. `program` is its path; null: what the
 * environment's REPOSE_VDB_READER names, else repose-vdb-reader as it is installed with the library. `memory`
 * is in bytes; 0: 512 MB and 128 times the file, at most half of the machine's. `seconds` is wall time, and of
 * computing; 0: 20 s, and one for each 4 MB of the file. Error: ARGUMENT, a limit that is negative or no
 * number. repose_engine_create and repose_change answer NO_INPUT where there is no such program, or where it
 * crashes or runs past its limits, and SCENE for a file that carries a checksum of Repose and is damaged.
 */
REPOSE_API repose_status repose_scene_vdb_reader(repose_scene scene, const char* program, double memory,
                                                 double seconds);

/**
 * The scene as compact JSON, after all that was set and with expressions evaluated. Copies as
 * repose_error_message does; `length` may be null. Error: SCENE.
 */
REPOSE_API repose_status repose_scene_json(repose_scene scene, char* buffer, size_t capacity, size_t* length);

/** Engines that were made of it stay as they are. */
REPOSE_API repose_status repose_scene_destroy(repose_scene scene);

/* Engines -----------------------------------------------------------------------------------------------------
 */

enum { REPOSE_LOG_WARNING = 1 };
/** Told what a scene most likely does not mean, though it is no error. `message` is valid within the call. */
typedef void (*repose_log_fn)(void* user, int32_t level, const char* message);

/**
 * For repose_engine_options::threads: the engine works in the arena of oneTBB that repose_engine_create is
 * called in, within what its maker has set: concurrency, NUMA node, observers. Calls from elsewhere work there
 * too.
 */
enum { REPOSE_THREADS_OF_CALLER = -1 };

enum { REPOSE_TARGET_BEST = 0, REPOSE_TARGET_BASELINE = 1, REPOSE_TARGET_AVX2 = 2, REPOSE_TARGET_AVX512 = 3 };

/** How an engine is made. */
typedef struct repose_engine_options {
  uint32_t size;       /**< of the struct, bytes */
  uint32_t version;    /**< REPOSE_STRUCT_VERSION */
  int32_t threads;     /**< of an arena of its own; 0: as many as the machine has; or
                            REPOSE_THREADS_OF_CALLER. They change no bit */
  int32_t target;      /**< instruction set; AVX2 and AVX-512 give the same bits */
  double memory_limit; /**< bytes that it may take; 0: 85 % of the machine's. What would need more is refused */
  int32_t log_contacts; /**< not 0: repose_contact can be asked; costs a little */
  int32_t reserved;     /**< 0 */
  repose_log_fn log;    /**< may be null; also told while the engine is made */
  void* log_user;       /**< what `log` is called with */
} repose_engine_options;
REPOSE_DEFINE_INIT(repose_engine_options)

/**
 * Makes a simulation: builds solids, fills bodies with particles. `options` may be null. The scene may be
 * destroyed or changed afterwards. Errors: SCENE, NO_INPUT, MEMORY, USAGE.
 */
REPOSE_API repose_status repose_engine_create(repose_scene scene, const repose_engine_options* options,
                                              repose_engine* engine);

/** A call that is under way on another thread is interrupted and ends first. */
REPOSE_API repose_status repose_engine_destroy(repose_engine engine);

/** What a call that advances came to. */
typedef struct repose_report {
  uint32_t size;    /**< of the struct, bytes */
  uint32_t version; /**< REPOSE_STRUCT_VERSION */
  int64_t frame;    /**< frames completed */
  int64_t step;     /**< steps completed, since the scene began */
  double time;      /**< s, of the scene */
  int64_t steps;    /**< made by this call */
  double least_dt;  /**< s, the shortest of those; 0 where there were none */
  double most_dt;   /**< s, the longest */
  int64_t redone;   /**< steps that were tried again by half */
  int32_t complete; /**< 1: the call got as far as it was to; 0: interrupted, call again to go on */
  int32_t reserved; /**< 0 */
  double seconds;   /**< of wall time */
} repose_report;
REPOSE_DEFINE_INIT(repose_report)

/**
 * @name Advancing
 * To the end of the frame at hand; `seconds` of the scene's time further, with frames that end on the way; or
 * by one step, which ends at the frame at the latest. `report` may be null. All three go along one line of time
 * and may be mixed. Errors: PHYSICS, MEMORY; the state is then that of the last step that was made.
 * @{
 */
/** To the end of the frame at hand. */
REPOSE_API repose_status repose_advance_frame(repose_engine engine, repose_report* report);
/** `seconds` of the scene's time further. Error: also ARGUMENT where they are below 0. */
REPOSE_API repose_status repose_advance_seconds(repose_engine engine, double seconds, repose_report* report);
/** By one step. */
REPOSE_API repose_status repose_advance_step(repose_engine engine, repose_report* report);
/** @} */

/**
 * Leaves the step at hand, or the next one, as it was before it: the call that advances returns REPOSE_OK with
 * `complete` 0. From any thread, or a callback.
 */
REPOSE_API repose_status repose_interrupt(repose_engine engine);

/** Where an engine is, for a callback. */
typedef struct repose_progress {
  uint32_t size;    /**< of the struct, bytes */
  uint32_t version; /**< REPOSE_STRUCT_VERSION */
  int64_t frame;    /**< frames completed */
  int64_t step;     /**< steps completed */
  double time;      /**< s, of the scene */
  double dt;        /**< s, of the step that was made */
} repose_progress;
/** Called after each step; what is not 0 ends the call that advances, with the state as it is. */
typedef int (*repose_progress_fn)(void* user, const repose_progress* progress);
/** `progress` null: nobody. */
REPOSE_API repose_status repose_set_progress(repose_engine engine, repose_progress_fn progress, void* user);
/** `log` null: nobody. Warnings that come while advancing are told before that call returns. */
REPOSE_API repose_status repose_set_log(repose_engine engine, repose_log_fn log, void* user);

/** All warnings so far: how many, and one of them; copies as repose_error_message does. */
REPOSE_API repose_status repose_warning_count(repose_engine engine, size_t* count);
/** A warning as text; `length` may be null. Error: ARGUMENT where there is none of the index. */
REPOSE_API repose_status repose_warning(repose_engine engine, size_t index, char* buffer, size_t capacity,
                                        size_t* length);

/** Figures of an engine. */
typedef struct repose_info {
  uint32_t size;             /**< of the struct, bytes */
  uint32_t version;          /**< REPOSE_STRUCT_VERSION */
  int64_t frame;             /**< frames completed */
  int64_t step;              /**< steps completed */
  double time;               /**< s, of the scene */
  uint64_t particles;        /**< that there are */
  uint64_t particles_asleep; /**< of them, those in blocks that take no part */
  uint64_t blocks;           /**< of nodes */
  uint64_t generation;       /**< of views: see repose_channel */
  double memory;             /**< bytes that it takes and has made room for */
  double writing_memory;     /**< bytes that a copy of the points takes for a while, about */
  int32_t threads;           /**< of its arena */
  int32_t target;            /**< a REPOSE_TARGET, never BEST */
  int32_t implicit;          /**< 1: steps are implicit */
  int32_t sound;             /**< 0: memory ran out in the midst of a change, and the state must not be saved */
} repose_info;
REPOSE_DEFINE_INIT(repose_info)
/** What it is at. */
REPOSE_API repose_status repose_engine_info(repose_engine engine, repose_info* info);

/** Of all numbers of all particles, and of the step: the one that `repose run` writes into run.json. */
REPOSE_API repose_status repose_hash(repose_engine engine, uint64_t* hash);

/**
 * Goes on with a key at another value: gravity, winds, friction, materials' strength, time.max_step. It is as
 * if the state had been saved and loaded into an engine made of that scene, and takes about as long as making
 * one without particles; sand that sleeps is woken. Errors: those of repose_engine_create; SCENE where a state
 * cannot go on so (bodies, grid, emitters, density, what particles keep); nothing has then changed.
 */
REPOSE_API repose_status repose_change(repose_engine engine, const char* key, const char* value);

/* State -------------------------------------------------------------------------------------------------------
 */

/** Takes `bytes` bytes; what is not 0 says that they could not be taken (IO). */
typedef int (*repose_write_fn)(void* user, const void* data, size_t bytes);
/**
 * @name The state, bit for bit
 * To a file, which appears whole or not at all, or through `write`; from a file or from memory. It goes into an
 * engine of the same scene, of any number of threads. What is damaged is refused (IO) and changes nothing.
 * Where colliders that the host leads stand is no part of it: say it after loading, with 0 s or at once.
 * Errors: CANNOT_WRITE, IO; NO_INPUT, SCENE (of another scene), IO, MEMORY.
 * @{
 */
/** To a file. */
REPOSE_API repose_status repose_state_save(repose_engine engine, const char* path);
/** From a file. */
REPOSE_API repose_status repose_state_load(repose_engine engine, const char* path);
/** Through `write`, piece by piece. */
REPOSE_API repose_status repose_state_write(repose_engine engine, repose_write_fn write, void* user);
/** From memory. */
REPOSE_API repose_status repose_state_read(repose_engine engine, const void* data, size_t bytes);
/** @} */

/* What the host does between calls that advance ---------------------------------------------------------------
 */

/**
 * A collider that the host leads (repose_scene_lead_pose) goes from where it stands to a pose within `seconds`
 * of the scene's time, straight and evenly, and rests there; with 0 it stands there at once, without a
 * velocity. `matrix` takes points from where the scene placed the shape to where they are; its columns follow
 * one another, so the translation is in entries 12, 13 and 14, as in OpenGL, USD and Houdini. It must be a
 * rotation and a translation. Error: USAGE.
 */
REPOSE_API repose_status repose_move_collider(repose_engine engine, const char* collider,
                                              const double matrix[16], double seconds);

/**
 * Says how the surface of a collider that the host leads (repose_scene_lead_pose) moves, in place of what its
 * poses come to: a belt that runs, a drum that turns in its place. A point x of it has velocity + spin x (x -
 * center), in the scene's frame: velocity[3] in m/s, spin[3] in rad/s, center[3] in m; spin and center may be
 * null, for zeros. It holds until it is said anew; `velocity` null: by its poses again. It bounds steps as any
 * speed of a collider. Error: USAGE.
 */
REPOSE_API repose_status repose_drive_collider(repose_engine engine, const char* collider,
                                               const double* velocity, const double* spin,
                                               const double* center);

/**
 * A mesh that the host leads (repose_scene_lead_mesh) goes to new places of its vertices by the end of the
 * stretch of 1/rate s that begins now; between stretches it cannot be said. `vertices`: x y z of each, m, in
 * coordinates as of the scene's mesh file. `triangles`: three corners of each, from 0, counter-clockwise from
 * outside; null: those of the last mesh. With the same triangles points move along straight lines, with others
 * the surface alone is known. `at_once` not 0: it stands there now. Errors: USAGE; SCENE where it is no closed
 * solid; MEMORY.
 */
REPOSE_API repose_status repose_deform_collider(repose_engine engine, const char* collider,
                                                const double* vertices, size_t vertex_count,
                                                const int32_t* triangles, size_t triangle_count,
                                                int32_t at_once);

/** What the material did to a collider. */
typedef struct repose_contact_info {
  uint32_t size;    /**< of the struct, bytes */
  uint32_t version; /**< REPOSE_STRUCT_VERSION */
  double seconds;   /**< of the scene, that it is the mean over: of the last call that advanced */
  double force[3];  /**< of the material on the collider, N */
  double moment[3]; /**< about the scene's origin, N m */
  double power;     /**< that the collider gives to the material, W */
} repose_contact_info;
REPOSE_DEFINE_INIT(repose_contact_info)
/** Error: USAGE where log_contacts was not asked for. */
REPOSE_API repose_status repose_contact(repose_engine engine, const char* collider,
                                        repose_contact_info* contact);

/**
 * Particles begin at an emitter of type "host", whose material and particles_per_cell they have: `count` of
 * them, at positions (x y z of each, m) with velocities (likewise, m/s; null: at rest). Ids follow one another
 * from `first_id` (may be null). Errors: USAGE, MEMORY.
 */
REPOSE_API repose_status repose_add_particles(repose_engine engine, const char* emitter,
                                              const double* positions, const float* velocities, size_t count,
                                              uint32_t* first_id);
/**
 * The same with numbers of the host's own, which follow the particles from then on: `channels` are names of the
 * scene's "channels", `values` for each of them `count` times as many numbers as it has components, particle by
 * particle. Particles have the scene's "initial" of channels that are not named, and all those that do not
 * begin here of all. Errors: USAGE also for a channel that the scene has not; MEMORY.
 */
REPOSE_API repose_status repose_add_particles_with(repose_engine engine, const char* emitter,
                                                   const double* positions, const float* velocities,
                                                   size_t count, const char* const* channels,
                                                   const float* const* values, size_t channel_count,
                                                   uint32_t* first_id);
/** Numbers per particle of one of the scene's "channels". Error: USAGE where there is none of the name. */
REPOSE_API repose_status repose_channel_components(repose_engine engine, const char* channel,
                                                   int32_t* components);
/**
 * Other numbers of a channel of the scene, for `count` particles of ids, of any body or emitter. Ids that are
 * not there are passed over; `found` (may be null) says how many there were. Error: USAGE, also for an id that
 * comes twice; nothing has then changed. Views stay good, and show the new numbers.
 */
REPOSE_API repose_status repose_set_values(repose_engine engine, const char* channel, const uint32_t* ids,
                                           const float* values, size_t count, size_t* found);
/**
 * Particles end. Ids that are not there are passed over; `removed` (may be null) says how many there were.
 * Error: USAGE where the scene has no emitter of type "host".
 */
REPOSE_API repose_status repose_remove_particles(repose_engine engine, const uint32_t* ids, size_t count,
                                                 size_t* removed);

#undef REPOSE_DEFINE_INIT
#undef REPOSE_DEFINE_INIT_WITH

#ifdef __cplusplus
}
#endif

#endif
