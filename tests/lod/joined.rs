//! Objects whose levels of detail another program made.
