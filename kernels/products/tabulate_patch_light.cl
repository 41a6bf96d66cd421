// The lighting W = sum of weight C_{eta_R} of patch lights (Neumann 2001, eqs. 5.23 and 4.2) between points of the base
// plane:
//   W(P, Q) = sum over shares of factor area(disc(P, R), disc(Q, R), unit disc),  factor = weight / (pi min(1, R^2))^2
// The area common to three discs by Green's theorem over their boundary arcs: the arc of each circle inside another
// disc is an interval of angles, and two intervals meet in at most two. Error: 1e-14 of factor R^2, 1e-8 where P and Q
// are within 1e-8 of each other.
// Packs run over P. Always in double precision.
#include "prelude.clh"

#define PI 3.14159265358979323846

// Twice Green's integral over the arc [from, to] of a circle about P, in angles from the direction -P:
// R^2 (to - from) - R |P| (sin to - sin from).
pack arc_share(const pack from, const pack to, const pack sin_from, const pack sin_to, const pack radius2,
               const pack lever) {
  return from < to ? radius2 * (to - from) - lever * (sin_to - sin_from) : (pack)(0.0);
}

// The same over what of the circle about P is inside the unit disc, at angles below `inside`, and inside the other
// disc, within `half_width` of `centre`.
pack circle_share(const pack inside, const pack sin_inside, const pack centre, const pack sin_centre,
                  const pack cos_centre, const pack half_width, const pack sin_half, const pack cos_half,
                  const pack radius2, const pack lever) {
  const pack low = centre - half_width;
  const pack high = centre + half_width;
  const pack sin_low = sin_centre * cos_half - cos_centre * sin_half;
  const pack sin_high = sin_centre * cos_half + cos_centre * sin_half;
  const pack first = arc_share(fmax(low, -inside), fmin(high, inside), low < -inside ? -sin_inside : sin_low,
                               high > inside ? sin_inside : sin_high, radius2, lever);
  // Once around, the interval may reach the arc again from below.
  const pack second = arc_share(-inside, high - 2 * PI, -sin_inside, sin_high, radius2, lever);
  return first + second;
}

// P in polar coordinates, and for one radius R half the arc of the unit circle inside its disc, half the arc of its
// circle inside the unit disc, and the sine of the latter.
typedef struct {
  pack radius, angle, cos_angle, sin_angle;
  pack unit_arc, own_arc, sin_own_arc;
} disc;

// Area for the angle delta in [0, pi] between P and Q at the origin.
pack common_area(const disc p, const disc q, const pack delta, const pack sin_delta, const pack cos_delta,
                 const double radius) {
  const pack inner = p.radius * q.radius * cos_delta;
  const pack cross = p.radius * q.radius * sin_delta;
  const pack difference = p.radius - q.radius;
  const pack distance2 = fmax(difference * difference + 2 * (p.radius * q.radius - inner), (pack)(0.0));
  const pack distance = sqrt(distance2);
  const pack cos_half = fmin(distance / (2 * radius), (pack)(1.0));
  const pack half_width = acos(cos_half);
  const pack sin_half = sqrt((1 - cos_half) * (1 + cos_half));

  // Angles of the triangle (origin, P, Q) at P and Q, with delta they sum to pi; any will do where P = Q.
  const pack along_p = p.radius * p.radius - inner;
  const pack along_q = q.radius * q.radius - inner;
  const pack length_p = sqrt(cross * cross + along_p * along_p);
  const pack length_q = sqrt(cross * cross + along_q * along_q);
  const pack nothing = fmin(length_p, length_q);
  // P at the origin has Q in the direction of Q.
  const pack at_p = nothing > 0.0 ? atan2(cross, along_p) : p.radius > 0.0 ? (pack)(0.0) : PI - delta;
  const pack sin_p = nothing > 0.0 ? cross / length_p : p.radius > 0.0 ? (pack)(0.0) : sin_delta;
  const pack cos_p = nothing > 0.0 ? along_p / length_p : p.radius > 0.0 ? (pack)(1.0) : -cos_delta;
  const pack sin_q = nothing > 0.0 ? cross / length_q : p.radius > 0.0 ? sin_delta : (pack)(0.0);
  const pack cos_q = nothing > 0.0 ? along_q / length_q : p.radius > 0.0 ? -cos_delta : (pack)(1.0);

  const pack unit_arc =
      fmax(fmin(p.unit_arc, delta + q.unit_arc) - fmax(-p.unit_arc, delta - q.unit_arc), (pack)(0.0)) +
      fmax(delta + q.unit_arc - 2 * PI + p.unit_arc, (pack)(0.0));
  const pack radius2 = (pack)(radius * radius);
  return 0.5 * (unit_arc +
                circle_share(p.own_arc, p.sin_own_arc, at_p, sin_p, cos_p, half_width, sin_half, cos_half, radius2,
                             radius * p.radius) +
                circle_share(q.own_arc, q.sin_own_arc, PI - delta - at_p, sin_q, cos_q, half_width, sin_half, cos_half,
                             radius2, radius * q.radius));
}

pack area_of(const disc p, const disc q, const double radius) {
  const pack apart = fabs(p.angle - q.angle);
  const pack delta = apart > PI ? 2 * PI - apart : apart;
  const pack cos_delta = p.cos_angle * q.cos_angle + p.sin_angle * q.sin_angle;
  const pack sin_delta = fabs(p.sin_angle * q.cos_angle - p.cos_angle * q.sin_angle);
  return common_area(p, q, delta, sin_delta, cos_delta, radius);
}

// p: 4 x row_stride: polar coordinates (radius, angle in [0, pi]) of P, cosine and sine of the angle; p_arcs: shares x
// 3 x row_stride, the last three members of `disc`. q, q_arcs: the same with column_stride. shares: radius and factor
// of each. values: columns x row_stride, from column first_column on. global size: (row_stride / REAL_WIDTH, columns of
// this call)
__kernel void tabulate_patch_light(__global const double* restrict p, __global const double* restrict p_arcs,
                                   const uint row_stride, __global const double* restrict q,
                                   __global const double* restrict q_arcs, const uint column_stride,
                                   const uint first_column, __global const double* restrict shares,
                                   const uint share_count, __global double* restrict values) {
  const uint row = (uint)get_global_id(0);
  const uint column = first_column + (uint)get_global_id(1);
  disc from, to;
  from.radius = LOAD_PACK(row, p);
  from.angle = LOAD_PACK(row, p + row_stride);
  from.cos_angle = LOAD_PACK(row, p + 2 * row_stride);
  from.sin_angle = LOAD_PACK(row, p + 3 * row_stride);
  to.radius = (pack)(q[column]);
  to.angle = (pack)(q[column_stride + column]);
  to.cos_angle = (pack)(q[2 * column_stride + column]);
  to.sin_angle = (pack)(q[3 * column_stride + column]);
  pack total = (pack)(0.0);
  for (uint k = 0; k < share_count; ++k) {
    __global const double* at_p = p_arcs + 3 * k * row_stride;
    __global const double* at_q = q_arcs + 3 * k * column_stride + column;
    from.unit_arc = LOAD_PACK(row, at_p);
    from.own_arc = LOAD_PACK(row, at_p + row_stride);
    from.sin_own_arc = LOAD_PACK(row, at_p + 2 * row_stride);
    to.unit_arc = (pack)(at_q[0]);
    to.own_arc = (pack)(at_q[column_stride]);
    to.sin_own_arc = (pack)(at_q[2 * column_stride]);
    const double radius = shares[2 * k];
    total += shares[2 * k + 1] * area_of(from, to, radius);
  }
  STORE_PACK(total, row, values + (size_t)get_global_id(1) * row_stride);
}
