//! Path tracing of daylight through shades: acceleration structure, materials, emitters, integrator, film.
