//! How far does a light reach before it falls under the display's smallest step?
