//! Promise: arithmetic keeps the digits that matter, however far away, thin, bright or near a thing is.
//!
//! | file | what it shows |
//! |---|---|
//! | `triangle` | solid angle, irradiance and points of a triangle, against high precision |
//! | `light_sampling` | every way to draw a point on a light gives the same light, and none shows a seam |
//! | `shading` | what a point adds is nothing or a sound number |
//! | `visibility` | shadow rays against a slow tracer in f64, and the traps of offsets and slabs |
//! | `watertight` | no ray passes between triangles that share an edge or a corner |
//! | `lone_triangle` | a ray and one triangle, against Moller and Trumbore's test in f64, however thin it is |
//! | `predicate`, `crossing` | where a line passes an edge and a mesh, exactly |
//! | `meshes` | meshes at random for these |
//! | `translation` | where a scene stands and how large it is changes nothing |
//! | `extreme` | every strategy stays finite, positive and right in `scenes/extreme` |
//! | `stability` | the verb shows where arithmetic breaks and that ours does not |

mod crossing;
mod extreme;
mod light_sampling;
mod lone_triangle;
mod meshes;
mod predicate;
mod shading;
mod stability;
mod translation;
mod triangle;
mod visibility;
mod watertight;
