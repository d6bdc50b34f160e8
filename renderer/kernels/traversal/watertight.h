// SPDX-License-Identifier: MIT
// Watertight ray-triangle intersection (S. Woop, C. Benthin, I. Wald, JCGT 2(1), 2013), of one
// triangle or of eight at once: this file is included for each, with REAL, MASK (an integer for
// each lane, 0 for false) and OF_LANES(name) defined. Operations and their order, hence all bits,
// are the same.
//
// Vertices are sheared to the ray's frame one by one, so neighbours agree on every shared vertex
// bit by bit; from there on the test is two-dimensional with edge functions of exact sign: a closed
// surface cannot be missed, neither at an edge nor at a vertex. (Plücker edge functions are
// antisymmetric too, but their rounded signs can disagree around a vertex.) Departure from the
// paper: edge functions are computed without cancellation error by fma(), instead of falling back
// on double precision where they vanish. That also keeps the weights, and so t, exact on slivers,
// which the paper's plain difference does not (a sliver of aspect 1e-4 hit itself from 1e-6 away).
//
// A triangle with a NaN or infinite coordinate is never hit, nor one that is a line or a point in
// the ray's frame. The error of t, as a length, is at most about u E (9 / cos + 12), where u =
// 2^-24, E is the largest distance from the origin to a vertex and cos that between its normal and
// the ray: the vertices' rounding across the ray, 6 u E on two axes (traversal_ray.h), tilts or
// shifts the plane, and t itself is rounded. For positions use the barycentrics
// (kernels/geometry/surface_point.h).

/// The edge functions a, b, c opposite to vertices 0, 1, 2 in the ray's frame, and the vertices'
/// distances along its main axis.
typedef struct OF_LANES(EdgeFunctions) {
    REAL a, b, c;
    REAL az, bz, cz;
} OF_LANES(EdgeFunctions);

/// ax * by - ay * bx to 1.5 ulp of the result, hence with the exact sign (Kahan's difference of
/// products; C.-P. Jeannerod, N. Louvet, J.-M. Muller, Math. Comp. 82, 2013), as long as no product
/// underflows.
DEVICE REAL OF_LANES(edge_function)(REAL ax, REAL ay, REAL bx, REAL by) {
    const REAL q = ay * bx;
    const REAL error = fma(-ay, bx, q);  // q - ay * bx, exactly
    return fma(ax, by, -q) + error;
}

/// Of the triangle with these vertices, whose coordinates are those along the ray's axes kx, ky,
/// kz.
DEVICE OF_LANES(EdgeFunctions)
    OF_LANES(edge_functions)(PRIVATE const TraversalRay *ray, REAL x0, REAL y0, REAL z0, REAL x1,
                             REAL y1, REAL z1, REAL x2, REAL y2, REAL z2) {
    OF_LANES(EdgeFunctions) edges;
    edges.az = z0 - ray->oz;
    edges.bz = z1 - ray->oz;
    edges.cz = z2 - ray->oz;
    const REAL ax = (x0 - ray->ox) - ray->sx * edges.az;
    const REAL ay = (y0 - ray->oy) - ray->sy * edges.az;
    const REAL bx = (x1 - ray->ox) - ray->sx * edges.bz;
    const REAL by = (y1 - ray->oy) - ray->sy * edges.bz;
    const REAL cx = (x2 - ray->ox) - ray->sx * edges.cz;
    const REAL cy = (y2 - ray->oy) - ray->sy * edges.cz;
    edges.a = OF_LANES(edge_function)(bx, by, cx, cy);
    edges.b = OF_LANES(edge_function)(cx, cy, ax, ay);
    edges.c = OF_LANES(edge_function)(ax, ay, bx, by);
    return edges;
}

/// Where the ray's line passes through the triangle or its edges. NaN passes here and fails in
/// meets_within.
DEVICE MASK OF_LANES(line_meets)(PRIVATE const OF_LANES(EdgeFunctions) * edges) {
    const MASK negative = (edges->a < 0.0f) | (edges->b < 0.0f) | (edges->c < 0.0f);
    const MASK positive = (edges->a > 0.0f) | (edges->b > 0.0f) | (edges->c > 0.0f);
    return (negative & positive) == 0;
}

/// Where, of such triangles, the hit lies at 0 < t < t_max; sets its t and its weights u, v of
/// vertices 1 and 2.
DEVICE MASK OF_LANES(meets_within)(PRIVATE const OF_LANES(EdgeFunctions) * edges,
                                   PRIVATE const TraversalRay *ray, float t_max, PRIVATE REAL *t,
                                   PRIVATE REAL *u, PRIVATE REAL *v) {
    // No cancellation from here on: a, b, c have one sign, so the weights are those of a convex
    // combination.
    const REAL inverse_area = 1.0f / (edges->a + edges->b + edges->c);
    *u = edges->b * inverse_area;
    *v = edges->c * inverse_area;
    *t = ray->sz * (edges->a * inverse_area * edges->az + *u * edges->bz + *v * edges->cz);
    return (*t > 0.0f) & (*t < t_max);  // false also when the area is 0 or anything was not finite
}
