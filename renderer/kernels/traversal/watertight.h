// SPDX-License-Identifier: MIT
// Watertight ray-triangle intersection, of one triangle or of eight at once.
//
// This file is included once for each, with REAL, MASK (an integer per lane, 0 for false) and
// OF_LANES(name) defined. Operations and their order are the same, hence all bits.
//
// Source: S. Woop, C. Benthin, I. Wald, JCGT 2(1), 2013. Vertices are sheared to the ray's frame
// one by one, so that neighbours agree on every shared vertex bit by bit. From there on the test is
// two-dimensional, with edge functions of exact sign. A closed surface cannot be missed, neither at
// an edge nor at a vertex. (Plücker edge functions are antisymmetric too, but their rounded signs
// can disagree around a vertex.)
//
// Departure: fma() computes the edge functions without cancellation error, while the paper falls
// back to double precision where they vanish. That also keeps the weights, and so t, exact on
// slivers. With the paper's plain difference, a sliver of aspect 1e-4 hit itself from 1e-6 away.
//
// A triangle with a NaN or infinite coordinate is never hit, nor one that is a line or a point in
// the ray's frame. The error of t, as a length, is at most about u E (9 / cos + 12). Here u =
// 2^-24, E is the largest distance from the origin to a vertex, and cos is the cosine between the
// triangle's normal and the ray. The vertices' rounding across the ray, 6 u E on two axes
// (traversal_ray.h), tilts or shifts the plane, and t itself is rounded. Positions should be
// computed from the barycentrics (kernels/geometry/surface_point.h).

/// The edge functions a, b, c opposite to vertices 0, 1, 2 in the ray's frame, and the vertices'
/// distances along its main axis.
typedef struct OF_LANES(EdgeFunctions) {
    REAL a, b, c;
    REAL az, bz, cz;
} OF_LANES(EdgeFunctions);

/// Returns ax * by - ay * bx to 1.5 ulp of the result, hence with the exact sign, as long as no
/// product underflows (Kahan's difference of products; C.-P. Jeannerod, N. Louvet, J.-M. Muller,
/// Math. Comp. 82, 2013).
DEVICE REAL OF_LANES(edge_function)(REAL ax, REAL ay, REAL bx, REAL by) {
    const REAL q = ay * bx;
    const REAL error = fma(-ay, bx, q);  // q - ay * bx, exactly
    return fma(ax, by, -q) + error;
}

/// Returns the edge functions of the triangle with these vertices, whose coordinates are along the
/// ray's axes kx, ky, kz.
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

/// Returns, per lane, whether the ray's line passes through the triangle or its edges. NaN passes
/// here and fails in meets_within.
DEVICE MASK OF_LANES(line_meets)(PRIVATE const OF_LANES(EdgeFunctions) * edges) {
    const MASK negative = (edges->a < 0.0f) | (edges->b < 0.0f) | (edges->c < 0.0f);
    const MASK positive = (edges->a > 0.0f) | (edges->b > 0.0f) | (edges->c > 0.0f);
    return (negative & positive) == 0;
}

/// Returns, per lane, whether such a triangle is hit at 0 < t < t_max. Sets t and the weights u, v
/// of vertices 1 and 2.
DEVICE MASK OF_LANES(meets_within)(PRIVATE const OF_LANES(EdgeFunctions) * edges,
                                   PRIVATE const TraversalRay *ray, float t_max, PRIVATE REAL *t,
                                   PRIVATE REAL *u, PRIVATE REAL *v) {
    // There is no cancellation from here on: a, b, c have one sign, so the weights are those of a
    // convex combination.
    const REAL inverse_area = 1.0f / (edges->a + edges->b + edges->c);
    *u = edges->b * inverse_area;
    *v = edges->c * inverse_area;
    *t = ray->sz * (edges->a * inverse_area * edges->az + *u * edges->bz + *v * edges->cz);
    // Also false if the area is 0 or a value is not finite.
    return (*t > 0.0f) & (*t < t_max);
}
