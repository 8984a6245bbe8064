/**
 * @file repose_reading.h
 * What repose.h, which includes it, lets a host read of an engine: copies of particles, numbers where they lie,
 * the material as volumes, and what probes measured.
 */
#ifndef REPOSE_REPOSE_READING_H
#define REPOSE_REPOSE_READING_H

#include "repose_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Particles ---------------------------------------------------------------------------------------------------
 */

enum { REPOSE_UP_OF_SCENE = 0, REPOSE_UP_Y = 1, REPOSE_UP_Z = 2 };

/** What a copy of the particles holds. */
typedef struct repose_points_options {
  uint32_t size;          /**< of the struct, bytes */
  uint32_t version;       /**< REPOSE_STRUCT_VERSION */
  const char* attributes; /**< beside P, v, id, pscale:
                             "stress,pressure,elastic_strain,density,speed,age,channels,shear_rate,
                             inertial_number,plastic_strain,velocity_gradient" or some of them, and
                             names of numbers that effects or the scene's "channels" keep; null: none */
  int32_t mass;           /**< not 0: also "mass" */
  int32_t up; /**< in which frame P, v, stress, elastic_strain and velocity_gradient are; a REPOSE_UP. Channels
                 are as they were given */
} repose_points_options;
REPOSE_DEFINE_INIT(repose_points_options)

/**
 * A copy of all particles in the order of their ids, which lasts until it is destroyed, whatever the engine
 * does. `options` may be null. Errors: USAGE for an attribute that is unknown or lacks
 * its key; MEMORY.
 */
REPOSE_API repose_status repose_points_create(repose_engine engine, const repose_points_options* options,
                                              repose_points* points);
/** The copy is no more. */
REPOSE_API repose_status repose_points_destroy(repose_points points);
/** How many particles it has. */
REPOSE_API repose_status repose_points_count(repose_points points, size_t* count);
/**
 * Numbers per particle of an attribute: 3 of "P" (m) and "v" (m/s), 1 of "pscale" (m), 6 of tensors (xx yy zz
 * xy yz xz, Pa), 9 of "velocity_gradient" (by rows, 1/s), of a channel what the scene says, 1 of the others.
 * Error: USAGE.
 */
REPOSE_API repose_status repose_points_components(repose_points points, const char* attribute,
                                                  int32_t* components);
/**
 * Copies count x components floats, particle by particle, into memory of the host that has room for `capacity`.
 * Errors: USAGE; ARGUMENT where there is too little room.
 */
REPOSE_API repose_status repose_points_read(repose_points points, const char* attribute, float* values,
                                            size_t capacity);
/**
 * The same in half precision (IEEE 754 binary16, its bits), rounded to the nearest: 11 digits of two, up to
 * 65504 and infinite beyond. Positions far from the origin have none left.
 */
REPOSE_API repose_status repose_points_read_half(repose_points points, const char* attribute, uint16_t* values,
                                                 size_t capacity);
/** Positions in double precision, m: x y z of each. */
REPOSE_API repose_status repose_points_positions(repose_points points, double* values, size_t capacity);
/** Ids, ascending. */
REPOSE_API repose_status repose_points_ids(repose_points points, uint32_t* ids, size_t capacity);
/**
 * Writes the copy to a file by its ending, .vdb (OpenVDB points), .ply or .vtp, as a run would
 * (docs/output.md): in the scene's frame, with the attributes that it was made with. It appears whole or not at
 * all. Errors: USAGE for another ending, CANNOT_WRITE, IO.
 */
REPOSE_API repose_status repose_points_write(repose_points points, const char* path);

/** The particles of one body or emitter. */
typedef struct repose_set {
  uint32_t size;          /**< of the struct, bytes */
  uint32_t version;       /**< REPOSE_STRUCT_VERSION */
  const char* name;       /**< of the body or emitter */
  const char* material;   /**< its name in the scene */
  double particle_mass;   /**< kg */
  double particle_volume; /**< m^3, at rest */
  uint64_t count;         /**< particles */
  uint64_t channels;      /**< how many */
  const uint32_t* begin;  /**< particles of block b are [begin[b], begin[b + 1]) */
  uint64_t blocks;        /**< how many; `begin` has one entry more */
  uint64_t generation;    /**< of what it points to */
} repose_set;
REPOSE_DEFINE_INIT(repose_set)

enum { REPOSE_FLOAT = 1, REPOSE_DOUBLE = 2, REPOSE_UINT32 = 3 };
/** Where the numbers of a channel lie. */
typedef struct repose_view {
  uint32_t size;    /**< of the struct, bytes */
  uint32_t version; /**< REPOSE_STRUCT_VERSION */
  const char*
      name;         /**< "id", "position.x" (cells from the corner of the particle's block), "velocity.x" (m/s),
                         "affine.xy" (1/s), "strain.xx" (elastic Hencky strain), and numbers that effects keep */
  const void* data; /**< the first of the numbers */
  uint64_t count;   /**< numbers, contiguous */
  uint64_t generation; /**< with which the view was made */
  int32_t type;        /**< REPOSE_FLOAT, REPOSE_DOUBLE or REPOSE_UINT32 */
  int32_t reserved;    /**< 0 */
} repose_view;
REPOSE_DEFINE_INIT(repose_view)

/**
 * @name Numbers where they lie
 * Particles come in sets, one for each body and emitter, and in a set block by block. Views copy nothing:
 * `data`, `begin` and the names are the engine's own memory, to be read alone, and valid until the next call
 * that advances, loads, changes, adds or removes. Each such call makes another generation; repose_view_check
 * says whether a view is still good. Errors: ARGUMENT for an index that is too large; USAGE for an unknown
 * name; STALE.
 * @{
 */
REPOSE_API repose_status repose_set_count(repose_engine engine, size_t* count);
REPOSE_API repose_status repose_set_info(repose_engine engine, size_t index, repose_set* set);
REPOSE_API repose_status repose_channel(repose_engine engine, size_t set, size_t index, repose_view* view);
REPOSE_API repose_status repose_channel_named(repose_engine engine, size_t set, const char* name,
                                              repose_view* view);
/** From any thread, at any time. */
REPOSE_API repose_status repose_view_check(repose_engine engine, uint64_t generation);
/**
 * Where the corners of the blocks lie, x y z of each, m: a particle is at corner + grid.spacing x position.
 * Copies 3 x `count` doubles into room for `capacity`; `corners` null asks for the count.
 */
REPOSE_API repose_status repose_block_corners(repose_engine engine, double* corners, size_t capacity,
                                              size_t* count);
/** @} */

/** A figure of a probe. */
typedef struct repose_measurement_info {
  uint32_t size;        /**< of the struct, bytes */
  uint32_t version;     /**< REPOSE_STRUCT_VERSION */
  const char* probe;    /**< its name in the scene */
  const char* quantity; /**< such as "force.x" */
  const char* unit;     /**< empty for a number of things */
  double value;         /**< not a number where there is none */
} repose_measurement_info;
REPOSE_DEFINE_INIT(repose_measurement_info)
/**
 * What the scene's probes have measured over the frame that was completed last. Texts are valid until the next
 * call on the engine that reads measurements or advances.
 */
REPOSE_API repose_status repose_measurement_count(repose_engine engine, size_t* count);
/** One of them. Error: ARGUMENT where there is none of the index. */
REPOSE_API repose_status repose_measurement(repose_engine engine, size_t index,
                                            repose_measurement_info* measurement);

/* Volumes -----------------------------------------------------------------------------------------------------
 */

/** How the surface of the material is drawn; 0, or below 0 of smoothing, is what the scene's output says. */
typedef struct repose_surface_options {
  uint32_t size;    /**< of the struct, bytes */
  uint32_t version; /**< REPOSE_STRUCT_VERSION */
  double voxel;  /**< m, from a sixteenth of grid.spacing to all of it; 0: that of the scene, or half of it */
  double radius; /**< m, half a spacing to four; gaps that a ball of it does not fit into are closed; 0: that
                      of the scene, or a spacing */
  int32_t smoothing; /**< times that it is averaged over neighbours; below 0: that of the scene, or 2 */
  int32_t reserved;  /**< 0 */
} repose_surface_options;
REPOSE_DEFINE_INIT_WITH(repose_surface_options, made.smoothing = -1;)

/**
 * The surface as a box of signed distances, "surface": m, negative inside, exact within three voxels of it, and
 * that much farther away. `options` may be null. It lasts until it is destroyed. Errors: USAGE; MEMORY where
 * the box, which goes about all of the material, needs more than memory_limit leaves.
 */
REPOSE_API repose_status repose_surface_create(repose_engine engine, const repose_surface_options* options,
                                               repose_volume* volume);
/**
 * The material on voxels of an edge (m, at least a sixteenth of grid.spacing; 0: that of the scene's output, or
 * grid.spacing), "density", kg/m^3, and "v", m/s, its momentum over its mass. Errors: as of surfaces.
 */
REPOSE_API repose_status repose_fog_create(repose_engine engine, double voxel, repose_volume* volume);
/** The box is no more. */
REPOSE_API repose_status repose_volume_destroy(repose_volume volume);

/** Where the values of a volume lie, in the scene's frame. */
typedef struct repose_lattice {
  uint32_t size;     /**< of the struct, bytes */
  uint32_t version;  /**< REPOSE_STRUCT_VERSION */
  double lower[3];   /**< where value (0, 0, 0) lies, m */
  double voxel[3];   /**< from one value to the next, m; all alike but in plane strain */
  uint64_t count[3]; /**< values along x, y and z; 0 where there is no material */
} repose_lattice;
REPOSE_DEFINE_INIT(repose_lattice)

/** Value (i, j, k) is number (i count[1] + j) count[2] + k, and lies at lower + (i, j, k) voxel. */
REPOSE_API repose_status repose_volume_lattice(repose_volume volume, repose_lattice* lattice);
/**
 * Copies the values of a grid, "surface", "density" or "v" (three numbers each), into room for `capacity`
 * floats. Errors: USAGE for a grid that it has not; ARGUMENT where there is too little room.
 */
REPOSE_API repose_status repose_volume_read(repose_volume volume, const char* grid, float* values,
                                            size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
