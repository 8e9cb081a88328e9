"""What others would run: one history by scipy, by heyoka, and a linear building by OpenSeesPy."""
