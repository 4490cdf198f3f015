// Runs ntdda's analysis on blocks that are given as they are, without a window and without its block cutter, and
// writes down every step. Linked with ntdda's own objects (README.md says how); started by ntdda.py.
// Usage: ntdda_run MODEL ANALYSIS HISTORY RESULT, in a folder of its own: ntdda writes its files there
//   MODEL     number of blocks; of each 1 when it is fixed (else 0), number of corners, x y of each; number of
//             steps whose blocks are written, these steps in ascending order
//   ANALYSIS  ntdda's analysis file (XML)
//   HISTORY   ntdda's "matlab" record: time step and number of values, then sideways accelerations [g] of every
//             moving block, one per step from step 0 on; the first step is number 1
//   RESULT    "step" number, wall and processor time [s], solutions of the equations (open-close iterations), 1 if
//             the last one changed no contact, contact points looked at; "blocks" number, coordinates of all
//             corners; "memory" bytes held before and after

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "contacts.h"
#include "dda.h"
#include "ddadlist.h"
#include "ddafile.h"
#include "ddamemory.h"
#include "timehistory.h"

Filepaths filepath;  // ntdda's objects expect it

// readers of timehistory.c: the analysis file's own entry calls them and then drops what they return
TimeHistory* parseMatlabFormat(FILE* file);

static FILE* result;
static int* looks;  // steps whose blocks are written, a zero at the end
static double memory_before;

static double seconds(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double resident_bytes(void) {
  double total = 0, resident = 0;
  FILE* file = fopen("/proc/self/statm", "r");
  if (file && fscanf(file, "%lf %lf", &total, &resident) != 2) resident = 0;
  if (file) fclose(file);
  return resident * (double)sysconf(_SC_PAGESIZE);
}

static FILE* opened(const char* path, const char* mode) {
  FILE* file = fopen(path, mode);
  if (!file) {
    fprintf(stderr, "ntdda_run: cannot open %s\n", path);
    exit(2);
  }
  return file;
}

static double number(FILE* file) {
  double value = 0;
  if (fscanf(file, "%lf", &value) != 1) {
    fprintf(stderr, "ntdda_run: the model ends too early or holds something else than numbers\n");
    exit(2);
  }
  return value;
}

static void write_blocks(const Geometrydata* gd, int step) {
  fprintf(result, "blocks %d", step);
  for (int b = 1; b <= gd->nBlocks; ++b)
    for (int j = gd->vindex[b][1]; j <= gd->vindex[b][2]; ++j)
      fprintf(result, " %.17g %.17g", gd->vertices[j][1], gd->vertices[j][2]);
  fprintf(result, "\n");
}

// ntdda calls this before the first step and after each one, to draw or to save the blocks. It stands here in place
// of its own display(), and what it takes stays outside the times.
void display(Geometrydata* gd, Analysisdata* ad) {
  static double wall, cpu;
  static int solutions;
  if (ad->cts > 0) {
    const double wall_now = seconds(CLOCK_MONOTONIC), cpu_now = seconds(CLOCK_PROCESS_CPUTIME_ID);
    fprintf(result, "step %d %.9g %.9g %d %d %d\n", ad->cts, wall_now - wall, cpu_now - cpu,
            ad->n9 - solutions, ad->m9 == -1, gd->nContacts);
    solutions = ad->n9;
    if (*looks == ad->cts) {
      write_blocks(gd, ad->cts);
      ++looks;
    }
    if (ad->cts == ad->nTimeSteps) {
      // its reports of the whole run are not asked for
      fprintf(result, "memory %.0f %.0f\n", memory_before, resident_bytes());
      exit(fclose(result) == 0 ? 0 : 2);
    }
  }
  wall = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
}

// A step whose displacement stays too large, however short it becomes, is taken again for ever.
int __real_checkParameters(Geometrydata* gd, Analysisdata* ad, Contacts* contacts, FILE* log);
int __wrap_checkParameters(Geometrydata* gd, Analysisdata* ad, Contacts* contacts, FILE* log) {
  enum { kMost = 200 };
  static int step, repeats;
  if (ad->cts != step) step = ad->cts, repeats = 0;
  const int again = __real_checkParameters(gd, ad, contacts, log);
  if (again && ++repeats == kMost) {
    fprintf(stderr, "ntdda_run: step %d has been taken %d times, its displacement stays too large\n", step,
            kMost);
    exit(3);
  }
  return again;
}

// Its tables of the matrix hold 40 places a block and are never checked: the fill-in of a wall of 7,000 blocks needs
// more. Larger ones, by telling those who allocate them of more blocks than there are.
enum { kRoom = 8 };
void __real_allocateAnalysisArrays(Geometrydata* gd, int** kk, int** k1, double*** c0, double*** u, int*** n);
void __wrap_allocateAnalysisArrays(Geometrydata* gd, int** kk, int** k1, double*** c0, double*** u,
                                   int*** n) {
  Geometrydata more = *gd;
  more.nBlocks = kRoom * gd->nBlocks;
  __real_allocateAnalysisArrays(&more, kk, k1, c0, u, n);
}
void __real_initStorageTempArrays(int blocks);
void __wrap_initStorageTempArrays(int blocks) { __real_initStorageTempArrays(kRoom * blocks); }
void __real_initContactTempArrays(int blocks, int vertices);
void __wrap_initContactTempArrays(int blocks, int vertices) {
  __real_initContactTempArrays(kRoom * blocks, vertices);
}

// Blocks as its cutter leaves them: numbered from 1, corners counter-clockwise; each has the last corner once more
// before its first one and four places after its last.
static Geometrydata* read_model(const char* path) {
  FILE* file = opened(path, "r");
  const int blocks = (int)number(file);
  Geometrydata* gd = gdata_new();
  gd->display_error = dda_display_error;
  gd->display_warning = dda_display_warning;
  gd->index = 1, gd->blocksize = 6;
  gd->nBlocks = blocks;
  gd->vindexsize1 = blocks + 1, gd->vindexsize2 = 3;
  gd->vindex = IntMat2DGetMem(blocks + 1, 3);
  gd->momentsize1 = blocks + 1, gd->momentsize2 = 9;
  gd->moments = DoubMat2DGetMem(blocks + 1, 9);

  enum { kMostCorners = 64 };
  const int places = (kMostCorners + 5) * blocks + 2;
  double(*corners)[2] = malloc(sizeof(double[2]) * (size_t)places);
  int* fixed = calloc((size_t)blocks + 1, sizeof(int));
  int next = 2, fixed_corners = 0;
  for (int b = 1; b <= blocks; ++b) {
    fixed[b] = (int)number(file);
    const int count = (int)number(file);
    if (count < 3 || count > kMostCorners) {
      fprintf(stderr, "ntdda_run: a block of %d corners\n", count);
      exit(2);
    }
    if (fixed[b]) fixed_corners += count;
    gd->vindex[b][0] = 1;  // material
    gd->vindex[b][1] = next, gd->vindex[b][2] = next + count - 1;
    for (int j = next; j < next + count; ++j) corners[j][0] = number(file), corners[j][1] = number(file);
    for (int j = 0; j < 4; ++j)
      memcpy(corners[next + count + j], corners[next + j % count], sizeof corners[0]);
    memcpy(corners[next - 1], corners[next + count - 1], sizeof corners[0]);
    next += count + 5;
  }
  const int look_count = (int)number(file);
  looks = calloc((size_t)look_count + 1, sizeof(int));
  for (int i = 0; i < look_count; ++i) looks[i] = (int)number(file);
  fclose(file);

  gd->vertexCount = next;
  gd->vertexsize1 = next + 1, gd->vertexsize2 = 3;
  gd->vertices = DoubMat2DGetMem(next + 1, 3);
  gd->origvertices = DoubMat2DGetMem(next + 1, 3);
  gd->pointCount = gd->nPoints = gd->nFPoints = fixed_corners;
  gd->pointsize1 = fixed_corners + 1, gd->pointsize2 = 10;
  gd->points = DoubMat2DGetMem(fixed_corners + 1, 10);
  gd->prevpoints = DoubMat2DGetMem(fixed_corners + 1, 10);
  gd->seispoints = dlist_new();
  int point = 0;
  for (int b = 1; b <= blocks; ++b) {
    for (int j = gd->vindex[b][1] - 1; j <= gd->vindex[b][2] + 4; ++j) {
      gd->vertices[j][0] = gd->origvertices[j][0] = 1;  // joint material of the edge that begins here
      gd->vertices[j][1] = gd->origvertices[j][1] = corners[j][0];
      gd->vertices[j][2] = gd->origvertices[j][2] = corners[j][1];
    }
    if (!fixed[b]) continue;
    for (int j = gd->vindex[b][1]; j <= gd->vindex[b][2]; ++j) {
      ++point;
      gd->points[point][1] = corners[j][0], gd->points[point][2] = corners[j][1], gd->points[point][3] = b;
    }
  }
  gdata_compute_moments(gd);
  for (int b = 1; b <= blocks; ++b) {
    if (fixed[b]) continue;
    DDAPoint* centroid = calloc(1, sizeof(DDAPoint));
    centroid->blocknum = b;
    centroid->x = gd->moments[b][7], centroid->y = gd->moments[b][8];
    dl_insert_b(gd->seispoints, centroid);
  }
  free(corners);
  free(fixed);
  return gd;
}

int main(int argc, char** argv) {
  if (argc != 5) {
    fprintf(stderr, "usage: ntdda_run MODEL ANALYSIS HISTORY RESULT\n");
    return 2;
  }
  Geometrydata* gd = read_model(argv[1]);
  Analysisdata* ad = adata_new();
  ad->display_error = dda_display_error;
  ad->display_warning = dda_display_warning;
  adata_read_input_file(ad, argv[2], gd->nFPoints, gd->pointCount, 0);
  FILE* history = opened(argv[3], "r");
  ad->timehistory = parseMatlabFormat(history);
  fclose(history);
  result = opened(argv[4], "w");

  DDA* dda = dda_new();
  dda_set_geometrydata(dda, gd);
  dda_set_analysisdata(dda, ad);
  strcpy(filepath.rootname, "run");
  memory_before = resident_bytes();
  ddanalysis(dda, &filepath);
  fprintf(stderr, "ntdda_run: the analysis ended before its last step\n");
  return 3;
}
