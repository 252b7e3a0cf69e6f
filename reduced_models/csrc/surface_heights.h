/* Heights of features at the contacts of a bearing, looked up in the tables of reduced_models.bearing.height_tables, and full films
 * in place of elements. */
#ifndef SURFACE_HEIGHTS_H
#define SURFACE_HEIGHTS_H

/* Tables over the angle on a track, in `columns` over the root of the compression. The first page has numbers: in its rows from 1 on
 * of every ball its height where it is larger than the others and its tables at both races, in row 0 the tables of the races, and turns of both
 * rings per turn of the shaft; 0 is no table. Others are tables, with columns over the root of the compression in the last row. */
typedef struct {
    int pages, rows, columns; /* 0 pages: smooth */
    const double *heights;    /* [pages][rows][columns] m */
} HeightTables;

/* A film that is solved outside: its force is straight about an approach without heights. Without a slope it is the element's. */
typedef struct {
    double force, slope, approach;
} FullFilm;

/* Height of a table at an angle on its track and a compression. */
double table_height(const HeightTables *h, int table, double angle, double compression);

/* Height at the contact of a ball with a race, 0 the inner one. The ball stands at psi, the shaft has turned, and the ball about its
 * own axis. */
double contact_height(const HeightTables *h, int ball, int race, double psi, double shaft, double own, double compression);

#endif
