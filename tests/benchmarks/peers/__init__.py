"""What others would run: one history by scipy and by heyoka."""
